#!/usr/bin/env node
// npx ffd-mesh COMMAND ...: the program itself, on real files.
import {readFileSync} from 'node:fs';
import {showFiles, streams} from '../dist/files.mjs';
import createProgram from '../dist/program.mjs';
import {runProgram} from '../dist/run.mjs';

const module = await WebAssembly.compile(readFileSync(new URL('../dist/program.wasm', import.meta.url)));
const {code} = await runProgram(createProgram, module, process.argv.slice(2), {...streams, prepare: showFiles});
process.exitCode = code;
