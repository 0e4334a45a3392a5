// A file as base64 of its gzip, which a page unpacks by DecompressionStream. Run as: node pack.mjs <file> <output>
import { readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

const [input, output] = process.argv.slice(2);
writeFileSync(output, gzipSync(readFileSync(input), { level: 9 }).toString("base64"));
