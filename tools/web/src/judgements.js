// What the reviewer decided: kept in the browser, handed over as JSON that `ukemi batch --rejects` reads.
import { idOf } from './reactions.js';

/// Tells which bake of a reaction was judged.
const bakeOf = (reaction) => reaction.digest ?? reaction.clip;

/// One verdict: { verdict: 'accept' | 'reject' | null, comment, bake }.
export class Judgements extends EventTarget {
  constructor(reactions, place) {
    super();
    this.byId = new Map(reactions.map((reaction) => [idOf(reaction), reaction]));
    this.storageKey = `ukemi-review:${place}`;
    this.verdicts = this.read();
    this.history = [];
    window.addEventListener('storage', (event) => {
      if (event.key !== this.storageKey) return;
      this.verdicts = this.read();
      this.dispatchEvent(new CustomEvent('change', { detail: null }));
    });
  }

  read() {
    try {
      const stored = JSON.parse(localStorage.getItem(this.storageKey));
      return new Map(Object.entries(stored?.verdicts ?? {}));
    } catch {
      return new Map();
    }
  }

  /// False where the browser keeps nothing (its storage is full or switched off).
  write() {
    try {
      localStorage.setItem(this.storageKey, JSON.stringify({ format: 1, verdicts: Object.fromEntries(this.verdicts) }));
      this.kept = true;
    } catch {
      this.kept = false;
    }
  }

  of(reaction) {
    return this.verdicts.get(idOf(reaction)) ?? { verdict: null, comment: '' };
  }
  verdict(reaction) {
    return this.of(reaction).verdict ?? null;
  }
  /// Judged, and baked anew since.
  isStale(reaction) {
    const { verdict, bake } = this.of(reaction);
    return Boolean(verdict && bake && bakeOf(reaction) && bake !== bakeOf(reaction));
  }

  set(reaction, change) {
    const id = idOf(reaction);
    const before = this.of(reaction);
    if ('verdict' in change) this.history.push({ id, before });
    const after = { ...before, ...change, bake: bakeOf(reaction) };
    if (after.verdict || after.comment) this.verdicts.set(id, after);
    else this.verdicts.delete(id);
    this.write();
    this.dispatchEvent(new CustomEvent('change', { detail: reaction }));
  }

  /// Takes back the last verdict; the reaction it was on, or null.
  undo() {
    const last = this.history.pop();
    if (!last) return null;
    if (last.before.verdict || last.before.comment) this.verdicts.set(last.id, last.before);
    else this.verdicts.delete(last.id);
    this.write();
    const reaction = this.byId.get(last.id) ?? null;
    this.dispatchEvent(new CustomEvent('change', { detail: reaction }));
    return reaction;
  }

  count(verdict) {
    let count = 0;
    for (const reaction of this.byId.values()) count += this.verdict(reaction) === verdict ? 1 : 0;
    return count;
  }

  exported() {
    const list = (verdict) =>
      [...this.byId.values()]
        .filter((reaction) => this.verdict(reaction) === verdict && (verdict || this.of(reaction).comment))
        .map(({ character, name, digest }) => ({ character, name, comment: this.verdicts.get(idOf({ character, name })).comment ?? '', ...(digest ? { digest } : {}) }));
    return { format: 1, rejects: list('reject'), accepts: list('accept'), comments: list(null) };
  }

  /// Takes over an exported file. Returns how many of its judgements are on reactions of this page.
  import(json) {
    if (json?.format !== 1 || !Array.isArray(json.rejects)) throw new Error('is not an exported review (format 1)');
    let count = 0;
    const take = (list, verdict) => {
      for (const { character, name, comment } of list ?? []) {
        const reaction = this.byId.get(`${character}/${name}`);
        if (!reaction) continue;
        this.verdicts.set(idOf(reaction), { verdict, comment: typeof comment === 'string' ? comment : '', bake: bakeOf(reaction) });
        ++count;
      }
    };
    take(json.comments, null);
    take(json.accepts, 'accept');
    take(json.rejects, 'reject');
    this.write();
    this.dispatchEvent(new CustomEvent('change', { detail: null }));
    return count;
  }
}
