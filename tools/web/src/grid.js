// The cards of all reactions that the filters leave, and the one that plays under the pointer or the keyboard.
import { address, el, glyph, svg } from './dom.js';
import { motionOf } from './player.js';
import { degrees, directionOf, excessOf, idOf, metres, seconds, summaryOf, troublesOf } from './reactions.js';
import { theStage } from './stage.js';

const HOVER_MS = 140;
const SLOW_FRAME_MS = 300; // of so many in a row: cards play no more, the machine draws too slowly for it
const SLOW_FRAMES = 4;
const calm = window.matchMedia('(prefers-reduced-motion: reduce)');

/// Where the blow comes from, seen from above with the figure looking down the page.
function compass(reaction) {
  const direction = directionOf(reaction);
  if (!direction) return null;
  const above = direction.elevation > 60;
  const arrow = svg('path', { d: 'M0 8.2V3.6M-2 5.4 0 3.4l2 2', transform: `rotate(${-direction.azimuth})` });
  return svg('svg', { class: 'compass', viewBox: '-9 -9 18 18', 'aria-hidden': 'true' },
    svg('circle', { r: 8.2 }), above ? svg('circle', { class: 'body', r: 3 }) : arrow, above ? null : svg('circle', { class: 'body', r: 1.7 }));
}

class Card {
  constructor(grid, reaction) {
    this.grid = grid;
    this.reaction = reaction;
    this.picture = el('div', { class: 'picture' }, reaction.thumbnail
      ? ['light', 'dark'].map((theme) => el('img', { class: theme, src: address(`review/${theme === 'dark' ? reaction.thumbnail_dark : reaction.thumbnail}`), alt: '', loading: 'lazy', decoding: 'async', width: 400, height: 300 }))
      : el('div', { class: 'none' }, reaction.error ?? 'no picture'));
    const f = reaction.figures ?? {};
    const bad = excessOf(reaction) > 1;
    const figure = (name, text, isBad) => el('div', {}, el('dt', {}, name), el('dd', { class: isBad && 'bad' }, text));
    this.comment = el('p', { class: 'comment', hidden: true });
    this.open = el('button', { type: 'button', class: 'open', tabindex: '-1', 'aria-describedby': 'keys', onclick: () => grid.openCard(this), onfocus: () => grid.onFocus(this) },
      this.picture,
      el('div', { class: 'text' },
        el('div', { class: 'name' }, reaction.name),
        el('div', { class: 'meta' }, compass(reaction), el('span', {}, [grid.manyCharacters ? reaction.character : null, summaryOf(reaction)].filter(Boolean).join(' · ') || ' ')),
        el('dl', {}, figure('excess', degrees(f.excess_max_deg ?? f.clip_excess_max_deg), bad), figure('travel', metres(f.travel_m)), figure('rest', f.settled === false ? 'none' : seconds(f.rest_time_s))),
        this.comment));
    this.accept = el('button', { type: 'button', class: 'accept', tabindex: '-1', title: 'Accept (A)', 'aria-label': `Accept ${reaction.name}`, onclick: () => grid.judge(reaction, 'accept') }, glyph('accept'));
    this.reject = el('button', { type: 'button', class: 'reject', tabindex: '-1', title: 'Reject (R)', 'aria-label': `Reject ${reaction.name}`, onclick: () => grid.judge(reaction, 'reject') }, glyph('reject'));
    this.node = el('li', { class: 'card', onpointerenter: (event) => event.pointerType === 'mouse' && grid.previewSoon(this), onpointerleave: () => grid.endPreview(this) },
      this.open,
      el('div', { class: 'flags' }, troublesOf(reaction).map((trouble) => el('span', { class: trouble.bad ? 'flag bad' : 'flag' }, trouble.text))),
      el('div', { class: 'judge' }, this.accept, this.reject));
    this.tell();
  }

  tell() {
    const { verdict, comment } = this.grid.judgements.of(this.reaction);
    this.node.dataset.verdict = verdict ?? '';
    this.accept.setAttribute('aria-pressed', String(verdict === 'accept'));
    this.reject.setAttribute('aria-pressed', String(verdict === 'reject'));
    this.comment.hidden = !comment;
    this.comment.replaceChildren(glyph('comment'), comment ?? '');
    const words = [this.reaction.name, this.reaction.character, summaryOf(this.reaction), ...troublesOf(this.reaction).map((t) => t.text)];
    if (verdict) words.push(verdict === 'accept' ? 'accepted' : 'rejected');
    this.open.setAttribute('aria-label', words.filter(Boolean).join(', '));
  }
}

export class Grid extends EventTarget {
  constructor(reactions, judgements) {
    super();
    this.judgements = judgements;
    this.manyCharacters = new Set(reactions.map((reaction) => reaction.character)).size > 1;
    this.list = el('ul', { class: 'grid', 'aria-label': 'Reactions', onkeydown: (event) => this.onKey(event) });
    this.empty = el('p', { class: 'notice', hidden: true }, 'No reaction fits these filters.');
    this.node = el('main', {}, this.list, this.empty);
    this.cards = new Map(reactions.map((reaction) => [idOf(reaction), new Card(this, reaction)]));
    judgements.addEventListener('change', ({ detail }) => {
      if (detail) this.cards.get(idOf(detail))?.tell();
      else for (const card of this.cards.values()) card.tell();
    });
  }

  show(reactions) {
    this.endPreview();
    this.shown = reactions.map((reaction) => this.cards.get(idOf(reaction)));
    this.list.replaceChildren(...this.shown.map((card) => card.node));
    this.empty.hidden = this.shown.length > 0;
    if (!this.shown.includes(this.current)) this.setCurrent(this.shown[0]);
  }

  setCurrent(card) {
    this.current?.open.setAttribute('tabindex', '-1');
    this.current = card;
    card?.open.setAttribute('tabindex', '0');
  }
  onFocus(card) {
    this.setCurrent(card);
    if (card.open.matches(':focus-visible')) this.previewSoon(card);
  }
  focus(reaction) {
    const card = reaction ? this.cards.get(idOf(reaction)) : this.current;
    if (!card || !this.shown.includes(card)) return this.current?.open.focus();
    this.setCurrent(card);
    card.open.focus({ focusVisible: true });
    card.node.scrollIntoView({ block: 'nearest' });
  }

  openCard(card) {
    this.setCurrent(card);
    this.endPreview();
    this.dispatchEvent(new CustomEvent('open', { detail: card.reaction }));
  }

  judge(reaction, verdict) {
    const next = this.judgements.verdict(reaction) === verdict ? null : verdict;
    this.judgements.set(reaction, { verdict: next });
    this.dispatchEvent(new CustomEvent('judged', { detail: { reaction, verdict: next } }));
  }

  // ---- the clip that plays on its card

  previewSoon(card) {
    if (calm.matches || this.tooSlow || !card.reaction.clip || this.previewed === card) return;
    this.endPreview();
    this.previewed = card;
    this.timer = setTimeout(() => this.preview(card), HOVER_MS);
  }

  async preview(card) {
    const stage = theStage();
    const motion = stage && (await motionOf(card.reaction).catch(() => null));
    if (!motion || this.previewed !== card) return;
    stage.time = 0;
    stage.ranges = false;
    stage.show(card.picture, [motion], { interactive: false });
    stage.frame();
    const begin = performance.now();
    let last = begin;
    let slow = 0;
    const tick = (now) => {
      if (this.previewed !== card || stage.canvas.parentElement !== card.picture) return;
      slow = now - last > SLOW_FRAME_MS ? slow + 1 : 0;
      last = now;
      if (slow >= SLOW_FRAMES) {
        this.tooSlow = true;
        this.endPreview();
        return;
      }
      stage.seek(((now - begin) / 1000) % (motion.duration + 0.5));
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  endPreview(card = this.previewed) {
    if (!card || this.previewed !== card) return;
    clearTimeout(this.timer);
    this.previewed = null;
    const stage = theStage();
    if (stage?.canvas.parentElement === card.picture) stage.hide();
  }

  // ---- keys

  columns() {
    const [first] = this.shown;
    const top = first.node.offsetTop;
    const next = this.shown.findIndex((card) => card.node.offsetTop !== top);
    return next < 0 ? this.shown.length : next;
  }

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || !this.current) return;
    const at = this.shown.indexOf(this.current);
    const go = (to) => this.focus(this.shown[Math.min(Math.max(to, 0), this.shown.length - 1)].reaction);
    const judged = (verdict) => {
      const next = this.shown[at + 1];
      this.judge(this.current.reaction, verdict);
      if (next) this.focus(next.reaction);
    };
    const actions = {
      ArrowLeft: () => go(at - 1),
      ArrowRight: () => go(at + 1),
      ArrowUp: () => at - this.columns() >= 0 && go(at - this.columns()),
      ArrowDown: () => go(at + this.columns()),
      PageUp: () => go(at - 3 * this.columns()),
      PageDown: () => go(at + 3 * this.columns()),
      Home: () => go(0),
      End: () => go(this.shown.length - 1),
      k: () => go(at - 1),
      j: () => go(at + 1),
      a: () => judged('accept'),
      r: () => judged('reject'),
      u: () => this.judgements.set(this.current.reaction, { verdict: null }),
      c: () => this.dispatchEvent(new CustomEvent('comment', { detail: this.current.reaction })),
    };
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (!Object.hasOwn(actions, name)) return;
    event.preventDefault();
    actions[name]();
  }
}
