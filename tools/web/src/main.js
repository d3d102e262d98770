// The review page: a table of reactions, filters over it, cards, a player.
import { el, glyph, key } from './dom.js';
import { Grid } from './grid.js';
import { Judgements } from './judgements.js';
import { register, table } from './library.js';
import { Player } from './player.js';
import { FILTERS, idOf, inOrder, matches, ORDERS, VERDICTS } from './reactions.js';

const SIZES = [
  { name: 'S', width: 168 },
  { name: 'M', width: 232 },
  { name: 'L', width: 340 },
];

function stored(name, fallback) {
  try {
    return localStorage.getItem(`ukemi-review-${name}`) ?? fallback;
  } catch {
    return fallback;
  }
}
function store(name, value) {
  try {
    localStorage.setItem(`ukemi-review-${name}`, value);
  } catch {
    // The page works without being remembered.
  }
}

/// The folder that the page lies in.
const place = decodeURIComponent(window.location.pathname).replace(/[^/]*$/, '');

class Page {
  constructor(data) {
    this.data = data;
    this.reactions = data.reactions.map((reaction, index) => ({ ...reaction, index }));
    this.name = (data.recipe ?? place.split('/').filter(Boolean).pop() ?? 'reactions').replace(/\.toml$/, '');
    this.judgements = new Judgements(this.reactions, place);
    this.filters = {};
    this.build();
    this.readAddress();
    this.listen();
    this.update();
    this.openAddressed();
  }

  // ---- elements

  build() {
    document.title = `${this.name} – review`;
    this.toastNode = el('div', { class: 'toast', role: 'status', 'aria-live': 'polite' });
    this.grid = new Grid(this.reactions, this.judgements);
    this.help = this.buildHelp();
    const keys = el('p', { id: 'keys', class: 'hidden' }, 'Enter opens, A accepts, R rejects, C comments, arrow keys move.');
    document.body.append(this.buildHead(), this.buildFilters(), this.grid.node, keys, this.help, this.toastNode);
    this.player = new Player(this.judgements);
    this.player.dialog.append(el('div', {})); // the toast moves in here while the player is open
    this.setTheme(stored('theme', 'system'));
    this.setSize(stored('size', 'M'));
  }

  buildHead() {
    this.acceptedBar = el('i', { class: 'accepted' });
    this.rejectedBar = el('i', { class: 'rejected' });
    this.progressText = el('p', { class: 'number' });
    this.file = el('input', { type: 'file', accept: '.json,application/json', class: 'hidden', tabindex: '-1', 'aria-hidden': 'true', onchange: () => this.importFile() });
    this.sizeButtons = SIZES.map(({ name }) => el('button', { type: 'button', 'aria-label': `Size ${name}`, onclick: () => this.setSize(name) }, name));
    const count = this.reactions.length;
    return el('header', { class: 'head' },
      el('h1', {}, this.name, el('small', {}, `${count} reaction${count === 1 ? '' : 's'}, ${this.data.generator}`)),
      el('div', { class: 'progress' }, el('div', { class: 'bar', 'aria-hidden': 'true' }, this.acceptedBar, this.rejectedBar), this.progressText),
      el('div', { class: 'tools' },
        el('button', { type: 'button', class: 'button', onclick: () => this.export(), title: 'Save the verdicts for ukemi batch --rejects (E)' }, glyph('save'), 'Export', key('E')),
        el('button', { type: 'button', class: 'button', onclick: () => this.file.click(), title: 'Take over verdicts that were exported before' }, glyph('open'), 'Import'), this.file,
        el('div', { class: 'segmented', role: 'group', 'aria-label': 'Size of the cards' }, this.sizeButtons),
        el('button', { type: 'button', class: 'button icon', onclick: () => this.nextTheme(), title: 'Light or dark (T)', 'aria-label': 'Light or dark' }, glyph('theme')),
        el('button', { type: 'button', class: 'button icon', onclick: () => this.help.showModal(), title: 'Keys and help (?)', 'aria-label': 'Keys and help' }, glyph('help'))));
  }

  buildFilters() {
    this.search = el('input', { type: 'search', placeholder: 'Search (/)', 'aria-label': 'Search', oninput: () => this.update() });
    this.selects = FILTERS.map((filter) => ({ filter, select: el('select', { 'aria-label': filter.label, onchange: () => this.update() }) }));
    const fields = this.selects.filter(({ filter }) => this.fillSelect(filter) > 1 || filter.key === 'result').map(({ filter, select }) => el('label', { class: 'field' }, filter.label, select));
    this.verdictButtons = VERDICTS.map(({ key: verdict, label }) => el('button', { type: 'button', onclick: () => this.setVerdict(verdict) }, label));
    this.order = el('select', { 'aria-label': 'Order', onchange: () => this.setOrder(this.order.value) }, ORDERS.map(({ key: value, label }) => el('option', { value }, label)));
    this.downButton = el('button', { type: 'button', class: 'button icon', 'aria-label': 'Largest first', title: 'Largest first', onclick: () => this.setDown(!this.down) });
    this.countText = el('span', { class: 'count number', role: 'status' });
    return el('div', { class: 'filters', role: 'search' },
      el('label', { class: 'field' }, 'Find', this.search), fields,
      el('div', { class: 'segmented', role: 'group', 'aria-label': 'Verdict' }, this.verdictButtons),
      el('span', { class: 'grow' }), this.countText,
      el('div', { class: 'sort' }, el('label', { class: 'field' }, 'Order', this.order), this.downButton));
  }

  /// Fills a filter's values with how many reactions have each; returns how many values there are.
  fillSelect(filter) {
    const counts = new Map();
    for (const reaction of this.reactions)
      for (const value of filter.values(reaction)) if (value) counts.set(value, (counts.get(value) ?? 0) + 1);
    const values = [...counts].sort(([a], [b]) => (filter.key === 'result' ? 0 : a < b ? -1 : 1));
    const { select } = this.selects.find((one) => one.filter === filter);
    select.replaceChildren(el('option', { value: '' }, filter.all), ...values.map(([value, count]) => el('option', { value }, `${value} (${count})`)));
    return values.length;
  }

  buildHelp() {
    const list = (title, rows) => el('div', {}, el('h3', {}, title), el('dl', {}, rows.flatMap(([names, text]) => [el('dt', {}, names.split(' ').flatMap((name) => [key(name), ' '])), el('dd', {}, text)])));
    return el('dialog', { class: 'help', 'aria-label': 'Keys and help', onclick: (event) => event.target === this.help && this.help.close() },
      el('h2', {}, 'Keys'),
      el('div', { class: 'columns' },
        list('Everywhere', [['A', 'accept'], ['R', 'reject'], ['U', 'clear the verdict'], ['Z', 'take back the last verdict'], ['C', 'comment'], ['J K', 'next, previous'], ['T', 'light or dark'], ['?', 'this help']]),
        list('All reactions', [['← → ↑ ↓', 'move'], ['Enter', 'open the player'], ['/', 'search'], ['Esc', 'from the filters to the cards'], ['E', 'export the verdicts']]),
        list('Player', [['Space', 'play or pause'], ['← →', 'a frame; with Shift ten'], ['Home End', 'start, end'], ['- +', 'slower, faster'], ['L', 'loop'], ['V', 'another view; drag turns, wheel zooms'], ['O', 'ranges of motion'], ['[ ]', 'another joint'], ['P', 'pin to compare'], ['Esc', 'back']])),
      el('h2', {}, 'Figures'),
      el('p', {}, 'Excess is how far a joint left its range of motion, before what little was left over was projected away; over 1° counts as an error. The timeline shows how near each joint of the clip is to the edge of its range at every moment: pale is far inside, amber is at the edge, where joints of a body at rest often lie, red is outside.'),
      el('p', {}, 'Verdicts stay in this browser. Export writes them to a file for ', el('code', {}, 'ukemi batch RECIPE --rejects FILE'), '; Import takes such a file over on another machine.'),
      el('form', { method: 'dialog' }, el('button', { class: 'button' }, 'Close')));
  }

  // ---- what is shown

  update() {
    for (const { filter, select } of this.selects) {
      this.filters[filter.key] = select.value;
      select.classList.toggle('active', select.value !== '');
    }
    const shown = this.reactions.filter((reaction) => matches(reaction, this.filters, this.search.value.trim()) && this.hasVerdict(reaction));
    this.shown = inOrder(shown, this.order.value, this.down);
    this.grid.show(this.shown);
    this.countText.textContent = `${this.shown.length} of ${this.reactions.length}`;
    this.tellProgress();
    this.writeAddress();
  }

  hasVerdict(reaction) {
    const verdict = this.judgements.verdict(reaction);
    return !this.verdict || (this.verdict === 'open' ? verdict === null : verdict === this.verdict);
  }

  tellProgress() {
    const accepted = this.judgements.count('accept');
    const rejected = this.judgements.count('reject');
    const all = Math.max(this.reactions.length, 1);
    this.acceptedBar.style.width = `${(100 * accepted) / all}%`;
    this.rejectedBar.style.width = `${(100 * rejected) / all}%`;
    this.progressText.textContent = `${accepted + rejected} of ${this.reactions.length} judged: ${accepted} accepted, ${rejected} rejected`;
  }

  setVerdict(verdict) {
    this.verdict = verdict;
    this.verdictButtons.forEach((button, i) => button.setAttribute('aria-pressed', String(VERDICTS[i].key === verdict)));
    this.update();
  }
  setOrder(value) {
    this.order.value = value;
    this.setDown(Boolean(ORDERS.find((order) => order.key === value)?.down));
  }
  setDown(down) {
    this.down = down;
    this.downButton.replaceChildren(glyph(down ? 'down' : 'up'));
    this.downButton.setAttribute('aria-pressed', String(down));
    this.update();
  }
  setSize(name) {
    const size = SIZES.find((one) => one.name === name) ?? SIZES[1];
    this.grid.list.style.setProperty('--card', `${size.width}px`);
    this.sizeButtons.forEach((button, i) => button.setAttribute('aria-pressed', String(SIZES[i] === size)));
    store('size', size.name);
  }

  setTheme(theme) {
    this.theme = theme;
    const dark = theme === 'dark' || (theme === 'system' && window.matchMedia('(prefers-color-scheme: dark)').matches);
    document.documentElement.dataset.theme = dark ? 'dark' : 'light';
    this.player?.repaint();
  }
  nextTheme() {
    this.setTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark');
    store('theme', this.theme);
  }

  toast(text, shortcut) {
    const parent = this.player.isOpen ? this.player.dialog : document.body;
    if (this.toastNode.parentElement !== parent) parent.append(this.toastNode);
    this.toastNode.replaceChildren(text, ...(shortcut ? ['  ', key(shortcut[0]), ` ${shortcut[1]}`] : []));
    this.toastNode.classList.add('shown');
    clearTimeout(this.toastTimer);
    this.toastTimer = setTimeout(() => this.toastNode.classList.remove('shown'), 2200);
  }

  // ---- the address keeps the filters and the open reaction

  readAddress() {
    const asked = new URLSearchParams(window.location.hash.slice(1));
    for (const { filter, select } of this.selects) {
      const value = asked.get(filter.key) ?? '';
      if ([...select.options].some((option) => option.value === value)) select.value = value;
    }
    this.search.value = asked.get('find') ?? '';
    const order = asked.get('order');
    this.order.value = ORDERS.some((one) => one.key === order) ? order : 'batch';
    this.down = asked.has('down') ? asked.get('down') === '1' : Boolean(ORDERS.find((one) => one.key === this.order.value).down);
    this.asked = asked.get('open');
    const verdict = asked.get('verdict') ?? '';
    this.verdict = VERDICTS.some((one) => one.key === verdict) ? verdict : '';
    this.setDown(this.down);
    this.setVerdict(this.verdict);
  }

  writeAddress() {
    const kept = new URLSearchParams();
    for (const [name, value] of Object.entries(this.filters)) if (value) kept.set(name, value);
    if (this.search.value) kept.set('find', this.search.value);
    if (this.verdict) kept.set('verdict', this.verdict);
    if (this.order.value !== 'batch') kept.set('order', this.order.value);
    if (this.down !== Boolean(ORDERS.find((one) => one.key === this.order.value).down)) kept.set('down', this.down ? '1' : '0');
    const open = this.player?.isOpen ? this.player.reaction : null;
    if (open) kept.set('open', idOf(open));
    const text = kept.toString();
    window.history.replaceState(null, '', text ? `#${text}` : window.location.pathname + window.location.search);
  }

  openAddressed() {
    const reaction = this.asked && this.reactions.find((one) => idOf(one) === this.asked);
    if (reaction) this.open(reaction);
  }

  // ---- what happens

  open(reaction) {
    const list = this.shown.includes(reaction) ? this.shown : this.reactions;
    return this.player.open(reaction, list);
  }

  listen() {
    this.grid.addEventListener('open', ({ detail }) => this.open(detail));
    this.grid.addEventListener('comment', async ({ detail }) => {
      await this.open(detail);
      this.player.comment.focus();
    });
    for (const source of [this.grid, this.player])
      source.addEventListener('judged', ({ detail: { reaction, verdict } }) =>
        this.toast(`${reaction.name}: ${verdict ? `${verdict}ed` : 'verdict cleared'}`, ['Z', 'takes it back']));
    this.player.addEventListener('told', ({ detail }) => this.toast(detail));
    this.player.addEventListener('shown', () => this.writeAddress());
    this.player.addEventListener('closed', ({ detail }) => {
      if (this.verdict) this.update();
      this.writeAddress();
      this.grid.focus(detail);
    });
    this.judgements.addEventListener('change', ({ detail }) => {
      this.tellProgress();
      if (this.judgements.kept === false) this.toast('This browser keeps nothing: export before you leave.');
      if (this.verdict && !this.player.isOpen) this.keepFocus(detail);
    });
    window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.setTheme(this.theme));
    document.addEventListener('keydown', (event) => this.onKey(event));
  }

  /// A reaction that its verdict takes out of the list leaves the focus with the next one.
  keepFocus() {
    const at = this.shown.indexOf(this.grid.current?.reaction);
    const focused = this.grid.list.contains(document.activeElement);
    this.update();
    if (focused && this.shown.length) this.grid.focus(this.shown[Math.min(Math.max(at, 0), this.shown.length - 1)]);
  }

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const typing = event.target.closest?.('input, textarea, select');
    if (typing) {
      if (event.key === 'Escape' && !this.player.isOpen) this.grid.focus();
      return;
    }
    const open = this.player.isOpen;
    const actions = {
      '/': () => !open && this.search.focus(),
      '?': () => this.help.showModal(),
      t: () => this.nextTheme(),
      e: () => this.export(),
      z: () => this.undo(),
    };
    const toCards = ['Escape', 'ArrowDown', 'ArrowRight', 'j'];
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (Object.hasOwn(actions, name)) {
      event.preventDefault();
      actions[name]();
    } else if (!open && !this.help.open && toCards.includes(name) && !this.grid.list.contains(event.target)) {
      event.preventDefault();
      this.grid.focus();
    }
  }

  undo() {
    const reaction = this.judgements.undo();
    if (!reaction) return this.toast('Nothing to take back.');
    this.toast(`${reaction.name}: verdict taken back`);
    if (this.player.isOpen) this.player.show(reaction);
    else this.grid.focus(reaction);
  }

  export() {
    const json = this.judgements.exported();
    const url = URL.createObjectURL(new Blob([`${JSON.stringify(json, null, 2)}\n`], { type: 'application/json' }));
    el('a', { href: url, download: `${this.name}-review.json` }).click();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
    this.toast(`Exported: ${json.accepts.length} accepted, ${json.rejects.length} rejected`);
  }

  async importFile() {
    const [file] = this.file.files;
    this.file.value = '';
    if (!file) return;
    try {
      const count = this.judgements.import(JSON.parse(await file.text()));
      this.toast(`Imported ${count} verdict${count === 1 ? '' : 's'} from ${file.name}`);
      this.update();
    } catch (error) {
      this.toast(`${file.name}: ${error instanceof SyntaxError ? 'is no JSON' : error.message}`);
    }
  }
}

globalThis.ukemi = { register };
table.then((data) => {
  globalThis.ukemi.page = new Page(data);
});
