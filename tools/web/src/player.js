// One reaction large: the figure, its time, its joints, the verdict; a second one pinned beside it.
import { address, el, glyph, key } from './dom.js';
import { loadCharacter, loadClip } from './library.js';
import { Motion } from './motion.js';
import { RomPanel, Timeline } from './player_charts.js';
import { figuresOf, idOf, summaryOf } from './reactions.js';
import { theStage } from './stage.js';

const SPEEDS = [0.1, 0.25, 0.5, 1, 2];
const VIEWS = [
  { name: 'across', turn: 0, height: 13 },
  { name: 'front', turn: 62, height: 8 },
  { name: 'behind', turn: 180, height: 20 },
  { name: 'above', turn: 0, height: 72 },
];
const calm = window.matchMedia('(prefers-reduced-motion: reduce)');

const pressed = (button, on) => button.setAttribute('aria-pressed', String(Boolean(on)));

export async function motionOf(reaction) {
  const clip = await loadClip(reaction.clip);
  return new Motion(await loadCharacter(clip.character), clip);
}

export class Player extends EventTarget {
  constructor(judgements) {
    super();
    this.judgements = judgements;
    this.time = 0;
    this.playing = false;
    this.speed = 1;
    this.loop = true;
    this.ranges = false;
    this.view = 0;
    this.pinned = null;
    this.advance = true;
    this.build();
    judgements.addEventListener('change', () => this.reaction && this.tellVerdict());
  }

  // ---- elements

  build() {
    const button = (name, label, shortcut, action, more = {}) =>
      el('button', { type: 'button', class: 'button', title: shortcut ? `${label} (${shortcut})` : label, onclick: action, ...more }, name ? glyph(name) : null, more.text ?? null);
    const icon = (name, label, shortcut, action) => button(name, label, shortcut, action, { class: 'button icon', 'aria-label': label });

    this.title = el('h2', { id: 'player-title' });
    this.placeText = el('span', { class: 'place number' });
    this.pinButton = el('button', { type: 'button', class: 'button', title: 'Keep this clip on the left and compare others with it', onclick: () => this.togglePin() }, glyph('pin'), el('span', {}, 'Pin to compare'), key('P'));
    this.advanceButton = el('button', { type: 'button', class: 'button plain advance', title: 'After a verdict, go on to the next reaction', onclick: () => this.toggleAdvance() }, 'Auto-advance');
    const bar = el('div', { class: 'bar' },
      el('button', { type: 'button', class: 'button plain', onclick: () => this.close() }, glyph('back'), 'All reactions', key('Esc')),
      this.title, el('span', { class: 'space' }), this.placeText,
      icon('up', 'Previous reaction', 'K or ↑', () => this.step(-1)), icon('down', 'Next reaction', 'J or ↓', () => this.step(1)),
      this.advanceButton, this.pinButton);

    this.captionA = el('div', { class: 'caption a', hidden: true });
    this.captionB = el('div', { class: 'caption b', hidden: true });
    this.divide = el('div', { class: 'divide', hidden: true });
    this.message = el('div', { class: 'message', hidden: true });
    this.rangesButton = el('button', { type: 'button', class: 'button', onclick: () => this.toggleRanges() }, 'Ranges', key('O'));
    this.viewButton = el('button', { type: 'button', class: 'button', onclick: () => this.turn() }, 'View', key('V'));
    this.stageTools = el('div', { class: 'tools' }, this.rangesButton, this.viewButton);
    this.place = el('div', { class: 'stage' }, this.captionA, this.captionB, this.divide, this.message, this.stageTools);

    this.acceptButton = el('button', { type: 'button', class: 'button accept', onclick: () => this.judge('accept') }, glyph('accept'), 'Accept', key('A'));
    this.rejectButton = el('button', { type: 'button', class: 'button reject', onclick: () => this.judge('reject') }, glyph('reject'), 'Reject', key('R'));
    this.comment = el('textarea', { 'aria-label': 'Comment', placeholder: 'Comment (C)', rows: 2, oninput: () => this.reaction && this.judgements.set(this.reaction, { comment: this.comment.value }) });
    this.stale = el('p', { class: 'stale', hidden: true }, 'Baked anew since it was judged.');
    this.figures = el('table', { class: 'figures' });
    this.warnings = el('ul', { class: 'warnings', 'aria-label': 'Warnings' });
    this.files = el('p', { class: 'files' });
    this.rom = new RomPanel();
    this.rom.onselect = (joint) => this.selectJoint(joint);
    this.romTitle = el('h3', {}, 'Range of motion');
    const side = el('div', { class: 'side', role: 'region', 'aria-label': 'Verdict and figures', tabindex: '0' },
      el('h3', {}, 'Verdict'), el('div', { class: 'verdict' }, this.acceptButton, this.rejectButton), this.comment, this.stale,
      this.romTitle, this.rom.node, el('h3', {}, 'Figures'), this.figures, this.warnings, this.files);

    this.playButton = el('button', { type: 'button', class: 'button play icon', 'aria-label': 'Play', title: 'Play or pause (Space)', onclick: () => this.togglePlay() }, glyph('play'));
    this.clock = el('span', { class: 'clock' });
    this.loopButton = icon('loop', 'Loop', 'L', () => this.toggleLoop());
    this.speedSelect = el('select', { 'aria-label': 'Speed', onchange: () => (this.speed = Number(this.speedSelect.value)) },
      SPEEDS.map((speed) => el('option', { value: speed, selected: speed === 1 }, `${speed} ×`)));
    this.timeline = new Timeline();
    this.timeline.onseek = (time) => this.seek(time, true);
    this.timeline.onselect = (joint) => this.selectJoint(joint);
    this.timePanel = el('div', { class: 'time' },
      el('div', { class: 'transport' }, icon('first', 'To the start', 'Home', () => this.seek(0, true)), icon('back', 'A frame back', '←', () => this.stepFrames(-1)),
        this.playButton, icon('next', 'A frame on', '→', () => this.stepFrames(1)), this.clock, this.loopButton, el('label', {}, 'Speed', this.speedSelect)),
      this.timeline.node);
    this.dialog = el('dialog', { class: 'player', 'aria-labelledby': 'player-title', onkeydown: (event) => this.onKey(event), onclose: () => this.onClose() }, bar, this.place, side, this.timePanel);
    document.body.append(this.dialog);
    pressed(this.loopButton, this.loop);
    pressed(this.advanceButton, this.advance);
    pressed(this.rangesButton, this.ranges);
  }

  // ---- opening

  get isOpen() {
    return this.dialog.open;
  }

  /// Shows a reaction of a list, through which the player steps.
  async open(reaction, list) {
    this.list = list;
    if (!this.dialog.open) {
      this.dialog.showModal();
      this.playButton.focus();
    }
    await this.show(reaction);
  }

  async show(reaction) {
    this.reaction = reaction;
    const asked = (this.asked = Symbol('asked'));
    this.tellHead();
    this.tellVerdict();
    this.tellFigures();
    this.dispatchEvent(new CustomEvent('shown', { detail: reaction }));
    let motion = null;
    let failure = reaction.clip ? null : reaction.error ?? 'There is no clip to play.';
    if (!failure) motion = await motionOf(reaction).catch((error) => ((failure = error.message), null));
    if (this.asked !== asked || !this.isOpen) return;
    this.motion = motion;
    this.tellMotion(failure);
    this.loadNext();
  }

  /// The next clip is there before it is asked for.
  loadNext() {
    const next = this.list[this.list.indexOf(this.reaction) + 1];
    if (next?.clip) loadClip(next.clip).then((clip) => loadCharacter(clip.character)).catch(() => {});
  }

  motions() {
    return this.pinned && this.motion && this.pinned.reaction !== this.reaction ? [this.pinned.motion, this.motion] : this.motion ? [this.motion] : [];
  }
  /// The shown clip first.
  ownFirst() {
    return [...this.motions()].reverse();
  }

  tellMotion(failure) {
    const motions = this.motions();
    const stage = theStage();
    const two = motions.length === 2;
    this.captionA.hidden = this.captionB.hidden = this.divide.hidden = !two;
    if (two) {
      this.captionA.textContent = `pinned: ${idOf(this.pinned.reaction)}`;
      this.captionB.textContent = idOf(this.reaction);
    }
    this.message.hidden = Boolean(this.motion && stage);
    this.stageTools.hidden = !(this.motion && stage);
    this.timePanel.hidden = !this.motion;
    const hasRanges = Boolean(this.motion?.joints.length);
    this.romTitle.hidden = this.rom.node.hidden = !hasRanges;
    if (!this.motion || !stage) {
      this.tellMessage(failure);
      stage?.hide();
    }
    this.setPlaying(false);
    if (!this.motion) return;
    this.joint = this.jointToShow();
    this.time = 0;
    if (stage) {
      stage.time = 0;
      stage.ranges = this.ranges;
      stage.show(this.place, motions, { interactive: true });
      this.applyView();
    }
    this.applyJoint();
    this.seek(0);
    if (!calm.matches) this.setPlaying(true);
  }

  /// The one that was chosen by hand, else the report's worst, else that of the clip.
  jointToShow() {
    for (const name of [this.jointName, this.reaction.figures?.worst_joint]) {
      const joint = this.motion.joints.findIndex((one) => one.name === name);
      if (joint >= 0) return joint;
    }
    return this.motion.worstJoint();
  }

  tellMessage(failure) {
    const picture = this.reaction.sheet ?? (this.reaction.thumbnail && `review/${this.reaction.thumbnail}`);
    this.message.replaceChildren(
      el('p', {}, failure ?? 'This browser has no WebGL, which the 3D player needs. Figures, ranges and verdicts work without it.'),
      ...(picture ? [el('img', { src: address(picture), alt: `Contact sheet of ${this.reaction.name}` })] : []),
    );
  }

  tellHead() {
    const { reaction, list } = this;
    this.title.replaceChildren(reaction.name, el('small', {}, [reaction.character, summaryOf(reaction)].filter(Boolean).join(' · ')));
    this.placeText.textContent = `${list.indexOf(reaction) + 1} of ${list.length}`;
    pressed(this.pinButton, this.pinned);
    this.pinButton.querySelector('span').textContent = this.pinned ? 'Unpin' : 'Pin to compare';
  }

  tellVerdict() {
    const { verdict, comment } = this.judgements.of(this.reaction);
    pressed(this.acceptButton, verdict === 'accept');
    pressed(this.rejectButton, verdict === 'reject');
    if (this.comment.value !== (comment ?? '')) this.comment.value = comment ?? '';
    this.stale.hidden = !this.judgements.isStale(this.reaction);
  }

  tellFigures() {
    const other = this.pinned && this.pinned.reaction !== this.reaction ? figuresOf(this.pinned.reaction) : null;
    const rows = figuresOf(this.reaction).map(([name, text, bad], i) =>
      el('tr', {}, el('th', { scope: 'row' }, name), other ? el('td', { class: other[i]?.[2] && 'bad' }, other[i]?.[1] ?? '–') : null, el('td', { class: bad && 'bad' }, text)));
    this.figures.replaceChildren(...(other ? [el('thead', {}, el('tr', {}, el('td'), el('td', {}, 'pinned'), el('td', {}, 'this')))] : []), el('tbody', {}, rows));
    this.warnings.replaceChildren(...(this.reaction.warnings ?? []).map((warning) => el('li', {}, warning)));
    this.warnings.hidden = this.warnings.children.length === 0;
    const files = [...new Set([...this.reaction.outputs, this.reaction.report, this.reaction.sheet].filter(Boolean))];
    this.files.replaceChildren(...files.map((file) => el('a', { href: address(file) }, file.split('/').pop())));
  }

  close() {
    this.dialog.close();
  }
  onClose() {
    if (this.isOpen) return; // opened again before it heard of its end
    this.setPlaying(false);
    this.asked = null;
    theStage()?.hide();
    this.pinned = null;
    this.motion = null;
    this.dispatchEvent(new CustomEvent('closed', { detail: this.reaction }));
  }

  // ---- time

  duration() {
    return Math.max(...this.motions().map((motion) => motion.duration), 0);
  }

  seek(time, byHand = false) {
    if (!this.motion) return;
    if (byHand) this.setPlaying(false);
    this.time = Math.min(Math.max(time, 0), this.duration());
    theStage()?.seek(this.time);
    if (!theStage()) this.motion.pose(this.time);
    this.timeline.seek(this.time);
    this.rom.seek(this.time);
    const frame = Math.round(this.time * this.motion.clip.fps);
    this.clock.replaceChildren(`${this.time.toFixed(2)} s `, el('small', {}, `of ${this.duration().toFixed(2)} · frame ${frame}`));
  }

  setPlaying(on) {
    if (this.playing === on) return;
    this.playing = on;
    this.playButton.replaceChildren(glyph(on ? 'pause' : 'play'));
    this.playButton.setAttribute('aria-label', on ? 'Pause' : 'Play');
    if (!on) return;
    if (this.time >= this.duration() - 1e-6) this.time = 0;
    let last = performance.now();
    const tick = (now) => {
      if (!this.playing || !this.motion) return;
      let time = this.time + ((now - last) / 1000) * this.speed;
      last = now;
      if (time > this.duration()) {
        if (!this.loop) {
          this.seek(this.duration());
          this.setPlaying(false);
          return;
        }
        time = 0;
      }
      this.seek(time);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  togglePlay() {
    this.setPlaying(!this.playing);
  }
  stepFrames(count) {
    const { fps } = this.motion?.clip ?? {};
    if (fps) this.seek((Math.round(this.time * fps) + count) / fps, true);
  }
  toggleLoop() {
    this.loop = !this.loop;
    pressed(this.loopButton, this.loop);
  }
  changeSpeed(by) {
    const i = Math.min(Math.max(SPEEDS.indexOf(this.speed) + by, 0), SPEEDS.length - 1);
    this.speed = SPEEDS[i];
    this.speedSelect.selectedIndex = i;
  }

  // ---- looking

  toggleRanges() {
    this.ranges = !this.ranges;
    pressed(this.rangesButton, this.ranges);
    const stage = theStage();
    if (!stage) return;
    stage.ranges = this.ranges;
    stage.ask();
  }

  turn() {
    this.view = (this.view + 1) % VIEWS.length;
    this.applyView();
  }
  applyView() {
    const { name, turn, height } = VIEWS[this.view];
    theStage()?.frame(turn, height);
    this.viewButton.title = `Seen from: ${name}`;
  }

  selectJoint(joint) {
    this.joint = joint;
    this.jointName = this.motion.joints[joint]?.name;
    this.applyJoint();
    this.rom.seek(this.time);
  }
  stepJoint(by) {
    const count = this.motion?.joints.length ?? 0;
    if (count) this.selectJoint((this.joint + by + count) % count);
  }
  applyJoint() {
    const motions = this.ownFirst();
    if (motions[0].joints.length) this.rom.show(motions, this.joint);
    this.timeline.show(motions, this.joint);
    const name = motions[0].joints[this.joint]?.name;
    theStage()?.select(this.motions().map((motion) => Math.max(motion.joints.findIndex((joint) => joint.name === name), 0)));
  }

  togglePin() {
    if (!this.motion) return;
    this.pinned = this.pinned ? null : { reaction: this.reaction, motion: this.motion };
    const { time } = this;
    this.tellHead();
    this.tellFigures();
    if (this.pinned) {
      this.dispatchEvent(new CustomEvent('told', { detail: 'Pinned. The next reactions are shown beside it.' }));
      return;
    }
    this.tellMotion(null);
    this.seek(time);
  }

  repaint() {
    if (!this.motion) return;
    theStage()?.repaint();
    this.timeline.redraw();
  }

  // ---- judging

  judge(verdict) {
    const { reaction } = this;
    const next = this.judgements.verdict(reaction) === verdict ? null : verdict;
    this.judgements.set(reaction, { verdict: next });
    this.dispatchEvent(new CustomEvent('judged', { detail: { reaction, verdict: next } }));
    if (next && this.advance) this.step(1);
  }
  toggleAdvance() {
    this.advance = !this.advance;
    pressed(this.advanceButton, this.advance);
  }

  step(by) {
    const next = this.list[this.list.indexOf(this.reaction) + by];
    if (next) this.show(next);
    else this.dispatchEvent(new CustomEvent('told', { detail: by > 0 ? 'That was the last one.' : 'This is the first one.' }));
  }

  onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target === this.comment) {
      if (event.key === 'Escape') {
        event.preventDefault();
        this.playButton.focus();
      }
      return;
    }
    const inSelect = event.target instanceof HTMLSelectElement;
    const onButton = event.target instanceof HTMLButtonElement && event.target !== this.playButton;
    const actions = {
      ' ': () => this.togglePlay(),
      ArrowLeft: () => this.stepFrames(event.shiftKey ? -10 : -1),
      ArrowRight: () => this.stepFrames(event.shiftKey ? 10 : 1),
      ArrowUp: () => this.step(-1),
      ArrowDown: () => this.step(1),
      Home: () => this.seek(0, true),
      End: () => this.seek(this.duration(), true),
      k: () => this.step(-1),
      j: () => this.step(1),
      a: () => this.judge('accept'),
      r: () => this.judge('reject'),
      u: () => this.judgements.set(this.reaction, { verdict: null }),
      c: () => this.comment.focus(),
      p: () => this.togglePin(),
      o: () => this.toggleRanges(),
      v: () => this.turn(),
      l: () => this.toggleLoop(),
      '-': () => this.changeSpeed(-1),
      '+': () => this.changeSpeed(1),
      '=': () => this.changeSpeed(1),
      '[': () => this.stepJoint(-1),
      ']': () => this.stepJoint(1),
    };
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (inSelect && (name.startsWith('Arrow') || name.length === 1 || name === 'Home' || name === 'End')) return;
    if (onButton && name === ' ') return;
    if (!Object.hasOwn(actions, name)) return;
    event.preventDefault();
    actions[name]();
  }

  /// Prints of feet on the floor at a time, left and right: for scripts.
  printsAt(time) {
    this.seek(time, true);
    const { prints } = theStage().views[0].overlay;
    prints.update(this.time);
    return prints.shown();
  }

  /// Places of all nodes of the shown clip at a time, metres, where the file puts them: for scripts.
  placesAt(time) {
    this.seek(time, true);
    this.motion.pose(this.time);
    const floor = this.motion.clip.floor_m;
    return this.motion.nodes.map((_, i) => {
      const { x, y, z } = this.motion.place(i);
      return [x, y + floor, z];
    });
  }
}
