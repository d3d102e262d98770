// drive.mjs WORK.json: a reviewer's visit to the page of `folder`, in a real browser. `judged` are times and the places
// of all nodes of one reaction as the program has them; `hostile` is a folder whose names are markup.
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join } from 'node:path';
import { launch, pageOf, seek, showAt } from './browser.mjs';

const work = JSON.parse(readFileSync(process.argv[2], 'utf8'));
const axe = readFileSync(new URL('./node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');
const PATIENCE_MS = 150000; // WebGL is drawn by the processor, which others may want too
let checks = 0;
let failures = 0;

function check(what, good, told = '') {
  checks += 1;
  failures += good ? 0 : 1;
  console.log(`${good ? 'ok    ' : 'FAILED'} ${what}${told === '' ? '' : `: ${told}`}`);
}
const equal = (what, got, wanted) =>
  check(what, JSON.stringify(got) === JSON.stringify(wanted), JSON.stringify(got) === JSON.stringify(wanted) ? '' : `${JSON.stringify(got)}, not ${JSON.stringify(wanted)}`);

/// A page that notes what went wrong on it and what it asked the network for.
async function visit(browser, address, { size = { width: 1100, height: 720 }, before, motion = 'reduce' } = {}) {
  const context = await browser.newContext({ viewport: size, reducedMotion: motion, acceptDownloads: true });
  context.setDefaultTimeout(PATIENCE_MS);
  const page = await context.newPage();
  const noted = { errors: [], requests: [] };
  page.on('pageerror', (error) => noted.errors.push(String(error)));
  page.on('console', (message) => message.type() === 'error' && noted.errors.push(message.text()));
  page.on('dialog', (dialog) => (noted.errors.push(`dialog ${dialog.message()}`), dialog.dismiss()));
  page.on('request', (request) => noted.requests.push(request.url()));
  if (before) await page.addInitScript(before);
  await page.goto(address);
  await page.waitForSelector('.card');
  return { context, page, noted };
}

const names = (page) => page.locator('.card .name').allTextContents();
const player = (page, script) => page.evaluate(`globalThis.ukemi.page.player.${script}`);

async function filtersAndOrder(page) {
  const all = (await names(page)).length;
  equal('a card for each reaction', all, work.reactions);
  await page.getByLabel('Target', { exact: true }).selectOption('head');
  const heads = await names(page);
  check('filter: target', heads.length > 0 && heads.length < all && heads.every((name) => name.startsWith('head')), heads.join(' '));
  await page.getByLabel('Target', { exact: true }).selectOption('');
  await page.getByLabel('From', { exact: true }).selectOption('left');
  check('filter: side', (await names(page)).every((name) => name.endsWith('left')));
  await page.getByLabel('From', { exact: true }).selectOption('');
  const outcomes = await page.evaluate(() => globalThis.ukemi.page.shown.map((one) => one.figures.outcome));
  check('outcomes are told', outcomes.every((one) => ['stood', 'stepped', 'fell'].includes(one)), outcomes.join(' '));
  await page.getByLabel('Outcome', { exact: true }).selectOption(outcomes[0]);
  equal('filter: outcome', (await names(page)).length, outcomes.filter((one) => one === outcomes[0]).length);
  await page.getByLabel('Outcome', { exact: true }).selectOption('');
  await page.getByLabel('Search', { exact: true }).fill('chest front');
  equal('search', await names(page), ['chest_front']);
  await page.getByLabel('Search', { exact: true }).fill('nothing like it');
  await page.getByText('No reaction fits').waitFor();
  check('an empty list says so', true);
  await page.getByLabel('Search', { exact: true }).fill('');
  await page.getByLabel('Order', { exact: true }).selectOption('excess');
  const excess = await page.evaluate(() => globalThis.ukemi.page.shown.map((one) => one.figures.excess_max_deg));
  equal('order: largest excess first', excess, [...excess].sort((a, b) => b - a));
  await page.getByRole('button', { name: 'Largest first' }).click();
  const up = await page.evaluate(() => globalThis.ukemi.page.shown.map((one) => one.figures.excess_max_deg));
  equal('order: the other way', up, [...excess].reverse());
  check('the address keeps the order', page.url().includes('order=excess'));
  await page.getByLabel('Order', { exact: true }).selectOption('name');
}

async function judgeByKeys(page) {
  await page.keyboard.press('Escape');
  await page.keyboard.press('Home');
  const order = await names(page);
  await page.keyboard.press('a');
  await page.keyboard.press('r');
  await page.keyboard.press('r');
  await page.keyboard.press('z');
  const verdicts = () => page.locator('.card').evaluateAll((cards) => cards.map((card) => card.dataset.verdict));
  equal('keys: accept, reject, take back', (await verdicts()).slice(0, 3), ['accept', 'reject', '']);
  await page.keyboard.press('Home');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Enter');
  await page.waitForFunction(() => globalThis.ukemi.page.player.motion);
  check('Enter opens the player', (await page.locator('#player-title').textContent()).startsWith(order[1]));
  await page.keyboard.press('c');
  await page.keyboard.type('the left hand <b>sticks</b>');
  await page.keyboard.press('Escape');
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => !globalThis.ukemi.page.player.isOpen && !window.location.hash.includes('open='));
  await page.reload();
  await page.waitForSelector('.card');
  equal('verdicts outlive the visit', (await verdicts()).slice(0, 2), ['accept', 'reject']);
  check('so does the comment', (await page.locator('.card .comment:visible').textContent()).includes('<b>sticks</b>'));
  check('progress', (await page.locator('.progress').textContent()).includes('1 accepted, 1 rejected'));
  return order;
}

async function exportAndImport(browser, page, order) {
  const waiting = page.waitForEvent('download');
  await page.keyboard.press('e');
  const file = await (await waiting).path();
  const [character] = work.judged.id.split('/');
  const { reactions } = JSON.parse(readFileSync(join(work.folder, 'manifest.json'), 'utf8'));
  const digest = (name) => reactions.find((one) => one.name === name).digest;
  const wanted = {
    format: 1,
    rejects: [{ character, name: order[1], comment: 'the left hand <b>sticks</b>', digest: digest(order[1]) }],
    accepts: [{ character, name: order[0], comment: '', digest: digest(order[0]) }],
    comments: [],
  };
  equal('export', JSON.parse(readFileSync(file, 'utf8')), wanted);
  const other = await visit(browser, page.url().split('#')[0]);
  await other.page.locator('input[type=file]').setInputFiles({ name: 'review.json', mimeType: 'application/json', buffer: readFileSync(file) });
  await other.page.waitForSelector('.card[data-verdict=reject]');
  check('import on another machine', (await other.page.locator('.progress').textContent()).includes('1 accepted, 1 rejected'));
  await other.page.locator('input[type=file]').setInputFiles({ name: 'bad.json', mimeType: 'application/json', buffer: Buffer.from('[]') });
  await other.page.getByText('is not an exported review').waitFor();
  check('a file that is no review says so', true);
  await other.context.close();
}

async function playAndScrub(page) {
  await showAt(page, work.judged.id, 0);
  const stage = page.locator('.player .stage');
  const first = await stage.screenshot();
  await page.keyboard.press(' ');
  await page.waitForFunction(() => globalThis.ukemi.page.player.time > 0.15);
  check('Space plays', await player(page, 'playing'));
  await page.keyboard.press(' ');
  const stopped = await player(page, 'time');
  await page.waitForTimeout(200);
  equal('Space stops', await player(page, 'time'), stopped);
  const track = await page.getByRole('slider', { name: 'Time' }).boundingBox();
  await page.mouse.click(track.x + 78 + 0.5 * (track.width - 86), track.y + 20);
  const half = await player(page, 'time');
  check('a click on the timeline scrubs', Math.abs(half / (await player(page, 'duration()')) - 0.5) < 0.02, half);
  check('the slider tells its value', Math.abs(Number(await page.getByRole('slider', { name: 'Time' }).getAttribute('aria-valuenow')) - half) < 0.01);
  await page.keyboard.press('ArrowRight');
  check('an arrow steps a frame', Math.abs((await player(page, 'time')) - half - 1 / 60) < 0.6 / 60);
  await page.waitForTimeout(300);
  const later = await stage.screenshot();
  check('the figure is drawn, and moves', !first.equals(later) && later.length > 15000, `${later.length} bytes`);
  await page.keyboard.press('o');
  await page.waitForTimeout(300);
  check('the ranges are drawn over it', !(await stage.screenshot()).equals(later));
}

/// A direction by two words is said in words.
async function namesOfDirections(page) {
  const told = await page.evaluate(() => {
    const { player: shown } = globalThis.ukemi.page;
    const kept = shown.reaction;
    shown.reaction = { ...kept, settings: { ...kept.settings, from: 'front_left' } };
    shown.tellHead();
    const text = shown.title.textContent;
    shown.reaction = kept;
    shown.tellHead();
    return text;
  });
  check('front left is told in words', told.includes('front left') && !told.includes('left°'), told);
}

/// The steps of a reaction as its report tells them leave prints where its feet are.
async function printsOfFeet(page) {
  const { id, contacts } = work.stepping;
  await showAt(page, id, 0);
  const start = (await player(page, 'printsAt(0)')).length;
  const end = await player(page, 'printsAt(1e9)');
  check('every step leaves a print', contacts.length > 0 && end.length - start === contacts.length, `${end.length - start} of ${contacts.length}`);
  const after = await player(page, `printsAt(${contacts[0].time_s + 0.01})`);
  check('from its contact on', after.length === start + 1 && after.at(-1).side === contacts[0].side, JSON.stringify(after));
  const [x, z] = after.at(-1).place;
  const far = Math.hypot(x - contacts[0].ankle[0], z - contacts[0].ankle[1]);
  check('under the foot', far < 0.1, `${far.toFixed(3)} m from the ankle`);
  await showAt(page, work.judged.id, 0);
}

async function placesOfJoints(page) {
  let largest = 0;
  let compared = 0;
  for (const [i, time] of work.judged.times.entries()) {
    const places = await player(page, `placesAt(${time})`);
    work.judged.places[i].forEach((wanted, node) => {
      largest = Math.max(largest, Math.hypot(...wanted.map((value, c) => value - places[node][c])));
      compared += 1;
    });
  }
  check('joints are where the program has them', compared >= 200 && largest < work.judged.tolerance_m, `${compared} places, at most ${(1000 * largest).toFixed(4)} mm apart`);
}

async function rangesOfJoints(page) {
  const told = await page.evaluate(() => {
    const { player: shown } = globalThis.ukemi.page;
    const inside = [];
    for (let joint = 0; joint < shown.motion.joints.length; ++joint) {
      shown.selectJoint(joint);
      for (const share of [0, 0.3, 0.7, 1]) {
        shown.seek(share * shown.duration());
        const area = document.querySelector('.rom polygon.area');
        const dot = document.querySelector('.rom .dot');
        const point = area.ownerSVGElement.createSVGPoint();
        Object.assign(point, { x: Number(dot.getAttribute('cx')), y: Number(dot.getAttribute('cy')) });
        const path = shown.motion.joints[joint];
        inside.push({ fill: area.isPointInFill(point) || area.isPointInStroke(point), margin: path.at(path.margin, shown.time) });
      }
    }
    return inside;
  });
  check('the moving point lies in its polygon', told.length === 68 && told.every(({ fill, margin }) => fill || margin > -0.3), `${told.filter((one) => one.fill).length} of ${told.length}`);
}

async function sideBySide(page) {
  await page.keyboard.press('p');
  const pinned = await player(page, 'reaction.name');
  await page.keyboard.press('j');
  await page.waitForFunction((name) => globalThis.ukemi.page.player.reaction.name !== name && document.querySelector('.caption.b').textContent, pinned);
  await page.waitForFunction(() => globalThis.ukemi.page.player.motions().length === 2);
  await seek(page, 0.4);
  const times = await player(page, 'motions().map((motion) => motion.time)');
  equal('two clips in step', times, [0.4, 0.4]);
  check('both are named', (await page.locator('.caption.a').textContent()).includes(pinned));
  await page.keyboard.press('p');
  await page.keyboard.press('a');
  check('a verdict in the player goes on to the next', (await player(page, 'reaction.name')) !== pinned);
  await page.keyboard.press('Escape');
  await page.waitForFunction(() => !globalThis.ukemi.page.player.isOpen);
  check('Escape goes back to the cards', true);
}

async function contrast(page, what) {
  await page.evaluate(axe);
  const found = await page.evaluate(() => globalThis.axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21aa'] }));
  const told = found.violations.map((one) => `${one.id} ${one.nodes[0].target} ${one.nodes[0].any[0]?.message ?? ''}`);
  check(`WCAG AA: ${what}`, told.length === 0, told.join('; '));
}

async function accessible(browser, address) {
  const { context, page } = await visit(browser, address);
  for (const theme of ['light', 'dark']) {
    await page.evaluate((name) => globalThis.ukemi.page.setTheme(name), theme);
    await contrast(page, `cards, ${theme}`);
    await showAt(page, work.judged.id, 0.5);
    await contrast(page, `player, ${theme}`);
    await page.keyboard.press('Escape');
    await page.waitForFunction(() => !globalThis.ukemi.page.player.isOpen);
  }
  await page.setViewportSize({ width: 400, height: 800 });
  const over = () => page.evaluate(() => Math.max(...[document.documentElement, ...document.querySelectorAll('dialog[open]')].map((one) => one.scrollWidth - one.clientWidth)));
  equal('nothing sticks out of a narrow window', await over(), 0);
  await showAt(page, work.judged.id, 0.5);
  equal('nor in the player', await over(), 0);
  await context.close();
}

async function withoutWebGL(browser, address) {
  const before = () => {
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function get(kind, ...more) {
      return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...more);
    };
  };
  const { context, page } = await visit(browser, address, { before });
  await page.locator('.card .open').first().click();
  await page.waitForSelector('.player .message:visible');
  check('says so without WebGL', (await page.locator('.player .message').textContent()).includes('no WebGL'));
  await page.waitForFunction(() => globalThis.ukemi.page.player.motion);
  await seek(page, 0.3);
  check('and works on', (await page.locator('.rom .told').textContent()).includes('swing'));
  await context.close();
}

async function hostileNames(browser) {
  const { context, page, noted } = await visit(browser, pageOf(work.hostile.folder));
  check('names are text', (await names(page)).includes(work.hostile.name) && (await page.locator('.card img[src=x]').count()) === 0);
  await page.locator('.card .open').first().click();
  await page.waitForFunction(() => globalThis.ukemi.page.player.motion);
  equal('and do nothing', noted.errors, []);
  await context.close();
}

/// The same page with each reaction many times over.
async function fiveHundred(browser) {
  const folder = mkdtempSync(join(tmpdir(), 'ukemi-many-'));
  cpSync(join(work.folder, 'index.html'), join(folder, 'index.html'));
  cpSync(join(work.folder, 'review'), join(folder, 'review'), { recursive: true });
  const file = join(folder, 'review/reactions.js');
  const text = readFileSync(file, 'utf8');
  const data = JSON.parse(text.slice(text.indexOf('{'), text.lastIndexOf('}') + 1));
  data.reactions = Array.from({ length: 500 }, (_, i) => ({ ...data.reactions[i % data.reactions.length], name: `reaction_${i}` }));
  writeFileSync(file, `ukemi.register("reactions","all",${JSON.stringify(data)});`);
  const begin = performance.now();
  const { context, page, noted } = await visit(browser, pageOf(folder));
  const opened = performance.now() - begin;
  equal('500 reactions: all listed', await page.locator('.card').count(), 500);
  check('500 reactions: no clip is loaded before it is asked for', !noted.requests.some((url) => url.includes('/clips/') || url.includes('/characters/')));
  const longest = await page.evaluate(() => {
    const { page: review } = globalThis.ukemi;
    let most = 0;
    for (const change of [() => review.setOrder('excess'), () => review.setVerdict('open'), () => review.setVerdict(''), () => ((review.search.value = '49'), review.update())]) {
      const start = performance.now();
      change();
      void document.body.offsetHeight;
      most = Math.max(most, performance.now() - start);
    }
    return most;
  });
  check('500 reactions: open and filter without a wait', opened < 60000 && longest < 3000, `opened in ${opened.toFixed(0)} ms, longest filter or order ${longest.toFixed(0)} ms`);
  await context.close();
  rmSync(folder, { recursive: true });
}

async function fromAServer(browser) {
  const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.webp': 'image/webp' };
  const server = createServer((request, response) => {
    try {
      const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
      response.setHeader('Content-Type', types[extname(path)] ?? 'application/octet-stream');
      response.end(readFileSync(join(work.folder, path)));
    } catch {
      response.statusCode = 404;
      response.end();
    }
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const { context, page, noted } = await visit(browser, `http://127.0.0.1:${server.address().port}/index.html`);
  await showAt(page, work.judged.id, 0.2);
  check('works from a web server', noted.errors.length === 0 && (await player(page, 'motion.duration')) > 0, noted.errors.join(' '));
  await context.close();
  server.close();
}

async function livePreview(browser, address) {
  const { context, page } = await visit(browser, address, { motion: 'no-preference' });
  await page.locator('.card .open').first().hover();
  await page.waitForSelector('.card canvas');
  check('a card plays under the pointer', true);
  await page.mouse.move(5, 5);
  await page.waitForFunction(() => !document.querySelector('.card canvas'));
  check('and stops when it leaves', true);
  await context.close();
}

const browser = await launch();
const address = pageOf(work.folder);
const { page, noted } = await visit(browser, address);
await filtersAndOrder(page);
const order = await judgeByKeys(page);
await exportAndImport(browser, page, order);
await playAndScrub(page);
await namesOfDirections(page);
await printsOfFeet(page);
await placesOfJoints(page);
await rangesOfJoints(page);
await sideBySide(page);
equal('no error on the way', noted.errors, []);
check('nothing but files of the folder', noted.requests.every((url) => url.startsWith(address.replace('index.html', '')) || url.startsWith('data:') || url.startsWith('blob:')));
await livePreview(browser, address);
await accessible(browser, address);
await withoutWebGL(browser, address);
await hostileNames(browser);
await fiveHundred(browser);
await fromAServer(browser);
await browser.close();
console.log(`${checks} checks, ${failures} failed`);
process.exit(checks > 30 && failures === 0 ? 0 : 1);
