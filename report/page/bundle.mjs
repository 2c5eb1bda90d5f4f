// SPDX-License-Identifier: MIT
// Bundles a page into one HTML text and that into a C++ source that defines FUNCTION:
//   node bundle.mjs NODE_MODULES FOLDER FUNCTION template.cc
// FOLDER holds main.js and style.css, and page.html where it has more than the one beside this file.
import {existsSync, readFileSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';

const [modulesPath, sourcePath, functionName, output] = process.argv.slice(2);
const modules = resolve(modulesPath);
const source = resolve(sourcePath);
const esbuild = createRequire(join(modules, 'any.js'))('esbuild');

function bundle(entry) {
  const result = esbuild.buildSync({
    entryPoints: [join(source, entry)],
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    target: 'es2020',
    legalComments: 'inline',
    nodePaths: [modules],
    logLevel: 'warning',
  });
  return result.outputFiles[0].text;
}

// Whatever is put in as text must not end the element it stands in.
const script = bundle('main.js').replaceAll('</script', '<\\/script');
const style = bundle('style.css').replaceAll('</style', '<\\/style');
const own = join(source, 'page.html');
const shared = join(dirname(fileURLToPath(import.meta.url)), 'page.html');
const html = readFileSync(existsSync(own) ? own : shared, 'utf8')
                 .replace('{{style}}', () => style)
                 .replace('{{script}}', () => script);

// Compilers limit the length of a literal, but not of literals in a row.
const kPieceLength = 8000;
const pieces = [];
for (let at = 0; at < html.length; at += kPieceLength)
  pieces.push(`    R"~page~(${html.slice(at, at + kPieceLength)})~page~"`);
writeFileSync(output, `// Made by report/page/bundle.mjs; do not edit.
#include "report/page_template.h"

namespace articap {

std::string_view ${functionName}() {
  static constexpr char kPage[] =
${pieces.join('\n')};
  return {kPage, sizeof kPage - 1};
}

}  // namespace articap
`);
