// Writes the page as one HTML file: node build.mjs OUTPUT.html
import { readFile, writeFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const output = process.argv[2];
if (!output) throw new Error('usage: node build.mjs OUTPUT.html');
const path = (name) => fileURLToPath(new URL(name, import.meta.url));

const bundle = async (entry) => {
  const result = await build({
    entryPoints: [path(entry)],
    bundle: true,
    minify: true,
    write: false,
    format: 'esm',
    target: ['chrome109', 'firefox115', 'safari16'],
    charset: 'utf8',
    legalComments: 'inline',
    logLevel: 'warning',
  });
  return result.outputFiles[0].text.trim();
};

const [html, script, style] = await Promise.all([readFile(path('index.html'), 'utf8'), bundle('main.ts'), bundle('style.css')]);
// Neither may end its element, and the exporter looks for the one end of the head.
const inScript = script.replaceAll(/<\/(?=script|head)/gi, '<\\/').replaceAll('<!--', '<\\!--');
const page = html.replace('/* style */', () => style).replace('/* script */', () => inScript);
if (page.split('</head>').length !== 2) throw new Error('the page must contain </head> once');
await writeFile(output, page);
