// Bundle the page's script and style into ../assets, with the licences of what they contain and the
// checksums of what they were made from.

import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";

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
  target: "es2022",
};

await build({
  ...options,
  entryPoints: ["src/main.js"],
  format: "iife",
  outfile: `${ASSETS}/report.js`,
  banner: { js: `/* Contains these libraries:\n\n${licences}\n*/` },
});
await build({ ...options, entryPoints: ["src/style.css"], outfile: `${ASSETS}/report.css` });
writeFileSync(`${ASSETS}/LICENSES.txt`, `${licences}\n`);

// A test compares these: a source that was changed without bundling again is noticed without Node.
const sources = readdirSync("src")
  .sort()
  .map((name) => `web/src/${name}`);
const files = ["assets/report.css", "assets/report.js", "web/package-lock.json", ...sources];
const line = (file) =>
  `${createHash("sha256")
    .update(readFileSync(`../${file}`))
    .digest("hex")}  ${file}\n`;
writeFileSync(`${ASSETS}/checksums.txt`, files.map(line).join(""));
