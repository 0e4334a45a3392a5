// Runs a program of WebAssembly (WASI) in node, with its arguments, the environment and the files of this machine:
//
//   node run_wasm.mjs PROGRAM.wasm [ARGUMENT...]
//
// Before node 20 this needs --experimental-wasi-unstable-preview1; later ones take the option and ignore it.
import {readFile} from 'node:fs/promises';
import process from 'node:process';
import {WASI} from 'node:wasi';

const program = process.argv.slice(2);
if (program.length === 0) {
  console.error('usage: run_wasm.mjs PROGRAM.wasm [ARGUMENT...]');
  process.exit(2);
}
const wasi = new WASI({
  version: 'preview1',
  args: program,
  env: process.env,
  preopens: {'/': '/', '.': process.cwd()},
  returnOnExit: true,
});
// Called by WebAssembly without a function of JavaScript between, those of node 20.20 damage its heap: it dies later.
const system = {};
for (const [name, call] of Object.entries(wasi.wasiImport)) system[name] = (...values) => call(...values);

try {
  const module = await WebAssembly.compile(await readFile(program[0]));
  const instance = await WebAssembly.instantiate(module, {wasi_snapshot_preview1: system});
  process.exitCode = wasi.start(instance);
} catch (error) {  // no such program, or a trap: it ended as by a signal
  console.error(`${program[0]}: ${error.stack}`);
  process.exitCode = 134;
}
