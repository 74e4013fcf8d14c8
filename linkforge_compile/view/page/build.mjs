// Makes out/view.html: index.html with the bundled script, the style and the licences of what is in it, in one file.
import { mkdirSync, readdirSync, readFileSync, renameSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const { outputFiles, metafile } = await build({
  entryPoints: ["src/main.ts"],
  outdir: "out",
  bundle: true,
  minify: true,
  write: false,
  platform: "browser",
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
  metafile: true,
});
const made = (ending) => outputFiles.find(({ path }) => path.endsWith(ending))?.text ?? "";

const packages = new Set(
  Object.keys(metafile.inputs).flatMap((file) => file.match(/^.*node_modules\/(?:@[^/]+\/)?[^/]+/)?.[0] ?? []),
);
const licenses = [...packages].sort().map((folder) => {
  const { name, version } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
  const file = readdirSync(folder).find((file) => /^licen[cs]e/i.test(file));
  return `${name} ${version}\n\n${readFileSync(`${folder}/${file}`, "utf8").trim()}`;
});

// What would end the element early, or, in a comment, the comment.
const inElement = (text, name) => text.replaceAll(new RegExp(`</(?=${name})`, "gi"), "<\\/").replaceAll("<!--", "<\\!--");
const parts = {
  "<!-- licenses -->": `<!--\n${licenses.join("\n\n----\n\n").replaceAll("--", "- -")}\n-->`,
  "/* style */": inElement(made(".css").trim(), "style"),
  "/* script */": inElement(made(".js").trim(), "script"),
};
const page = Object.entries(parts).reduce(
  (text, [place, part]) => text.replace(place, () => part),
  readFileSync("index.html", "utf8"),
);
mkdirSync("out", { recursive: true });
// Renamed, because two builds may run at once.
writeFileSync(`out/view.${process.pid}.html`, page);
renameSync(`out/view.${process.pid}.html`, "out/view.html");
