// validate.mjs LIST.json: the Khronos validator on every {name, before, after} of the list. What is written may
// have no issue that the source has not: the count of no code may rise. Without a source (before: null) it may have
// none at all, except for what `allowed` names.
import { readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import validator from 'gltf-validator';

async function countsOf(path) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
    uri: path,
    maxIssues: 0,
    externalResourceFunction: async (uri) =>
      new Uint8Array(readFileSync(join(dirname(path), decodeURIComponent(uri)))),
  });
  const counts = new Map();
  for (const { code, severity } of report.issues.messages)
    counts.set(`${severity} ${code}`, (counts.get(`${severity} ${code}`) ?? 0) + 1);
  return { counts, animations: report.info.animationCount };
}

const list = JSON.parse(readFileSync(process.argv.at(-1), 'utf8'));
let checked = 0;
let failures = 0;
for (const { name, before, after, allowed = [] } of list) {
  const written = await countsOf(after);
  const source = before ? await countsOf(before) : { counts: new Map(), animations: 0 };
  const fresh = [...written.counts].filter(
    ([issue, count]) => count > (source.counts.get(issue) ?? 0) && !allowed.includes(issue.split(' ')[1]));
  for (const [issue, count] of fresh)
    console.log(`${name}: severity ${issue} ${count} times, ${source.counts.get(issue) ?? 0} in the source`);
  if (!(written.animations >= 1)) console.log(`${name}: no animation`);
  failures += fresh.length > 0 || !(written.animations >= 1) ? 1 : 0;
  ++checked;
}
console.log(`${checked} files validated, ${failures} with new issues`);
process.exit(checked > 0 && failures === 0 ? 0 : 1);
