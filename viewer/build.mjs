// Builds the page into the command's sources, where it is committed; `--check` says whether what is committed is what this builds.

import { build } from 'esbuild';
import { readFile, writeFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const page = (name) => here(`../crates/fredholm-cli/src/view/page/${name}`);

// What the page draws with is another's work; its licence travels with it.
const licence = (await readFile(here('node_modules/three/LICENSE'), 'utf8')).trim();

const common = { bundle: true, minify: true, write: false, target: 'es2022', legalComments: 'none', charset: 'utf8' };
const script = await build({
  ...common,
  entryPoints: [here('src/main.ts')],
  format: 'iife',
  banner: { js: `/* three.js\n${licence}\n*/` },
});
const style = await build({ ...common, entryPoints: [here('src/viewer.css')] });
const built = {
  'index.html': await readFile(here('src/index.html'), 'utf8'),
  'viewer.js': script.outputFiles[0].text,
  'viewer.css': style.outputFiles[0].text,
};

if (process.argv.includes('--check')) {
  for (const [name, text] of Object.entries(built)) {
    if ((await readFile(page(name), 'utf8')) !== text) {
      console.error(`${page(name)} is not what viewer/ builds: run \`npm run build\` in viewer/ and commit it`);
      process.exitCode = 1;
    }
  }
} else {
  for (const [name, text] of Object.entries(built)) await writeFile(page(name), text);
}
