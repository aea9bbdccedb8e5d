// Runs the Khronos glTF validator over files.
//     node validate.mjs FOLDER-WITH-NODE_MODULES < list-of-paths
// Prints for each path, as it comes, one line of JSON: {"path", "errors": [[code, pointer], ...], "codes": [code, ...]}, the
// codes being those of all severities, or {"path", "failed": why}.
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';
import { createInterface } from 'node:readline';

const validator = createRequire(path.resolve(process.argv[2], 'package.json'))('gltf-validator');
const ERROR = 0;

async function validate(file) {
    const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
        uri: path.basename(file),
        maxIssues: 0,
        writeTimestamp: false,
        externalResourceFunction: async (uri) =>
            new Uint8Array(await readFile(path.join(path.dirname(file), decodeURIComponent(uri)))),
    });
    const { messages } = report.issues;
    const errors = messages
        .filter((message) => message.severity === ERROR)
        .map((message) => [message.code, message.pointer ?? `@${message.offset ?? ''}`]);
    return { errors, codes: [...new Set(messages.map((message) => message.code))] };
}

for await (const file of createInterface({ input: process.stdin })) {
    if (!file) continue;
    let line;
    try {
        line = { path: file, ...(await validate(file)) };
    } catch (problem) {
        line = { path: file, failed: String(problem) };
    }
    console.log(JSON.stringify(line));
}
