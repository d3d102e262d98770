// Writes the review page's files to assets/web: one classic script (browsers load no modules from disk), the style
// sheet and the page. What it writes is committed: neither a build nor an installation needs npm or a network, and
// tests/browser finds out when it is not what the sources make. `npm ci && npm run build`; build.mjs FOLDER writes
// elsewhere.
import { copyFileSync, mkdirSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const target = resolve(process.argv[2] ?? join(here, '../../assets/web'));

mkdirSync(target, { recursive: true });
await build({
  absWorkingDir: here,
  entryPoints: ['src/main.js'],
  outfile: join(target, 'review.js'),
  bundle: true,
  format: 'iife',
  minify: true,
  charset: 'ascii',
  target: ['chrome100', 'firefox100', 'safari15'],
  legalComments: 'inline',
  banner: { js: '// The review page of ukemi, made from tools/web by `npm run build`. Holds three.js (MIT licence).' },
});
for (const file of ['index.html', 'review.css']) copyFileSync(join(here, 'src', file), join(target, file));
