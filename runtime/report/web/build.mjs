// Bundle the page's script and style into ../assets, with the licences of what they contain.

import { readFileSync, writeFileSync } from "node:fs";

import { build } from "esbuild";

const ASSETS = "../assets";
const LIBRARIES = ["three", "uplot"];

const licences = LIBRARIES.map((name) => {
  const { version } = JSON.parse(readFileSync(`node_modules/${name}/package.json`, "utf8"));
  const text = readFileSync(`node_modules/${name}/LICENSE`, "utf8").trim();
  return `${name} ${version}\n\n${text}`;
}).join(`\n\n${"-".repeat(72)}\n\n`);

const options = {
  bundle: true,
  minify: true,
  charset: "utf8",
  legalComments: "none", // the whole licences are in the banner
  logLevel: "warning",
};

await build({
  ...options,
  entryPoints: ["src/main.js"],
  format: "iife",
  target: "es2022",
  outfile: `${ASSETS}/report.js`,
  banner: { js: `/* Contains these libraries:\n\n${licences}\n*/` },
});
await build({
  ...options,
  entryPoints: ["src/style.css"],
  target: "es2022",
  outfile: `${ASSETS}/report.css`,
});
writeFileSync(`${ASSETS}/LICENSES.txt`, `${licences}\n`);
