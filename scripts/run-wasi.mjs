// Runs a WebAssembly program of the system interface WASI with this process's standard streams.
// usage: node scripts/run-wasi.mjs PROGRAM
import {readFileSync} from 'node:fs';
import {argv, exit} from 'node:process';
import {WASI} from 'node:wasi';

const wasi = new WASI({version: 'preview1', args: [argv[2]], returnOnExit: true});
const module = await WebAssembly.compile(readFileSync(argv[2]));
const imports = {wasi_snapshot_preview1: wasi.wasiImport};
exit(wasi.start(await WebAssembly.instantiate(module, imports)));
