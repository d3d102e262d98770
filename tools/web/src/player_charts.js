// The flat pictures of the player: a joint's range with the moving point, and the timeline.
import { el, svg } from './dom.js';
import { NEAR_DEG, OUTSIDE_DEG } from './motion.js';

const MARGIN_TOP_DEG = 4; // at least this much is shown over the edge
const MARGIN_BOTTOM_DEG = 30; // and this much below
const PLOT_HEIGHT = 70;
const STRIP_HEIGHT = 8;
const LABEL_WIDTH = 78;

const states = (margin) => (margin > OUTSIDE_DEG ? 'out' : margin > -NEAR_DEG ? 'near' : '');

/// One joint: its polygon in (a_y, a_z), the way through it, the point now, and the twist below.
export class RomPanel {
  constructor() {
    this.select = el('select', { 'aria-label': 'Joint', onchange: () => this.onselect?.(this.select.selectedIndex) });
    this.drawing = svg('svg', { viewBox: '0 0 316 300', role: 'img' });
    this.told = el('p', { class: 'told' });
    this.node = el('div', { class: 'rom' }, this.select, this.drawing, this.told);
  }

  /// `motions`: the shown one, and the other where two are compared.
  show(motions, selected) {
    this.joints = motions.map((motion, i) => (i === 0 ? motion.joints[selected] : motion.joints.find((j) => j.name === motions[0].joints[selected]?.name)));
    this.select.replaceChildren(
      ...motions[0].joints.map((joint, i) => {
        const largest = Math.max(...joint.margin);
        const told = largest > OUTSIDE_DEG ? `${largest.toFixed(1)}° outside` : `${(-Math.min(largest, 0)).toFixed(0)}° left`;
        return el('option', { selected: i === selected }, `${joint.name.replaceAll('_', ' ')} (${told})`);
      }),
    );
    this.draw();
  }

  draw() {
    const [joint, other] = this.joints;
    this.drawing.replaceChildren();
    if (!joint) return;
    this.drawing.setAttribute('aria-label', `Range of motion of ${joint.name.replaceAll('_', ' ')}, with the clip’s way through it`);
    const corners = joint.polygon_deg;
    const all = [...corners, ...Array.from(joint.ay, (ay, i) => [ay, joint.az[i]]), [0, 0]];
    const low = [0, 1].map((i) => Math.min(...all.map((p) => p[i])));
    const high = [0, 1].map((i) => Math.max(...all.map((p) => p[i])));
    const span = Math.max(high[0] - low[0], high[1] - low[1], 20);
    const scale = 208 / span;
    const middle = [0, 1].map((i) => (low[i] + high[i]) / 2);
    this.x = (ay) => 158 + (ay - middle[0]) * scale;
    this.y = (az) => 128 - (az - middle[1]) * scale;
    const points = (list) => list.map(([ay, az]) => `${this.x(ay).toFixed(1)},${this.y(az).toFixed(1)}`).join(' ');
    const path = Array.from(joint.ay, (ay, i) => [ay, joint.az[i]]);
    this.path = path;
    this.points = points;
    this.passed = svg('polyline', { class: 'passed' });
    this.dot = svg('circle', { class: 'dot', r: 6 });
    this.other = svg('circle', { class: 'other', r: 6, visibility: other ? 'visible' : 'hidden' });
    const [[yLow, yHigh], [zLow, zHigh], [tLow, tHigh]] = joint.meanings;
    this.drawing.append(
      svg('line', { class: 'axis', x1: 8, x2: 308, y1: this.y(0), y2: this.y(0) }),
      svg('line', { class: 'axis', x1: this.x(0), x2: this.x(0), y1: 16, y2: 240 }),
      svg('polygon', { class: 'area', points: points(corners) }),
      svg('polyline', { class: 'trail', points: points(path) }),
      this.passed,
      this.other,
      this.dot,
      svg('text', { x: 8, y: this.y(0) - 5 }, yLow),
      svg('text', { x: 308, y: this.y(0) - 5, 'text-anchor': 'end' }, yHigh),
      svg('text', { x: this.x(0) + 5, y: 13 }, zHigh),
      svg('text', { x: this.x(0) + 5, y: 250 }, zLow),
      ...this.twistBar(joint, tLow, tHigh),
    );
  }

  twistBar(joint, meaningLow, meaningHigh) {
    const [low, high] = joint.twist_deg;
    const from = Math.min(low, ...joint.twist);
    const to = Math.max(high, ...joint.twist);
    this.tx = (twist) => 22 + (272 * (twist - from)) / Math.max(to - from, 1);
    this.twistDot = svg('circle', { class: 'dot', r: 5, cy: 268 });
    return [
      svg('rect', { class: 'area', x: this.tx(low), width: this.tx(high) - this.tx(low), y: 263, height: 10, rx: 5 }),
      this.twistDot,
      svg('text', { x: 8, y: 292 }, meaningLow ? `twist: ${meaningLow}` : 'twist'),
      svg('text', { x: 308, y: 292, 'text-anchor': 'end' }, meaningHigh),
    ];
  }

  seek(time) {
    const [joint, other] = this.joints;
    if (!joint) return;
    const ay = joint.at(joint.ay, time);
    const az = joint.at(joint.az, time);
    const twist = joint.at(joint.twist, time);
    const margin = joint.at(joint.margin, time);
    const state = states(margin);
    this.dot.setAttribute('cx', this.x(ay));
    this.dot.setAttribute('cy', this.y(az));
    this.dot.setAttribute('class', `dot ${state}`);
    this.twistDot.setAttribute('cx', this.tx(twist));
    this.twistDot.setAttribute('class', `dot ${state}`);
    this.passed.setAttribute('points', this.points([...this.path.slice(0, Math.floor(joint.frame(time)) + 1), [ay, az]]));
    if (other) {
      this.other.setAttribute('cx', this.x(other.at(other.ay, time)));
      this.other.setAttribute('cy', this.y(other.at(other.az, time)));
    }
    const place = el('b', {}, margin > OUTSIDE_DEG ? `${margin.toFixed(1)}° outside` : `${(-margin).toFixed(1)}° inside its edge`);
    this.told.replaceChildren(`swing ${ay.toFixed(0)}°, ${az.toFixed(0)}°; twist ${twist.toFixed(0)}°; `, place);
  }
}

/// Time from left to right: the largest excess of all joints, the selected joint's distance to its edge, and a strip
/// for each joint. A slider: it seeks by pointer, and tells its value.
export class Timeline {
  constructor() {
    this.canvas = el('canvas', { 'aria-hidden': 'true' });
    this.legend = el('div', { class: 'legend' });
    this.track = el('div', { class: 'timeline', role: 'slider', tabindex: '0', 'aria-label': 'Time', 'aria-valuemin': '0' }, this.canvas);
    this.node = el('div', {}, this.track, this.legend);
    const seek = (event) => {
      const box = this.canvas.getBoundingClientRect();
      const share = (event.clientX - box.left - LABEL_WIDTH) / (box.width - LABEL_WIDTH - 8);
      this.onseek?.(Math.min(Math.max(share, 0), 1) * this.duration);
      const row = this.rowAt(event.clientY - box.top);
      if (event.type === 'pointerdown' && row !== null) this.onselect?.(row);
    };
    this.track.addEventListener('pointerdown', (event) => {
      this.track.setPointerCapture(event.pointerId);
      seek(event);
    });
    this.track.addEventListener('pointermove', (event) => event.buttons && seek(event));
    new ResizeObserver(() => this.motions && this.redraw()).observe(this.track);
  }

  rowAt(y) {
    const row = Math.floor((y - PLOT_HEIGHT - 6) / (STRIP_HEIGHT + 2));
    return row >= 0 && row < this.motions[0].joints.length ? row : null;
  }

  show(motions, selected) {
    this.motions = motions;
    this.selected = selected;
    this.duration = Math.max(...motions.map((motion) => motion.duration), 1e-3);
    this.track.setAttribute('aria-valuemax', this.duration.toFixed(2));
    const worst = Math.max(...motions.flatMap((motion) => (motion.joints.length ? [Math.max(...motion.worst())] : [])), 0);
    this.top = Math.max(MARGIN_TOP_DEG, 1.15 * worst);
    this.redraw();
  }

  colors() {
    const style = getComputedStyle(document.documentElement);
    const of = (name) => style.getPropertyValue(name).trim();
    return { ink: of('--ink'), soft: of('--soft'), line: of('--line'), sunken: of('--sunken'), bad: of('--bad'), near: of('--near'), good: of('--good'), focus: of('--focus') };
  }

  redraw() {
    const colors = this.colors();
    const joints = this.motions[0].joints;
    const width = this.track.clientWidth;
    if (width === 0) return;
    const height = PLOT_HEIGHT + 6 + joints.length * (STRIP_HEIGHT + 2) + 16;
    const ratio = window.devicePixelRatio || 1;
    const picture = document.createElement('canvas');
    for (const canvas of [picture, this.canvas]) {
      canvas.width = width * ratio;
      canvas.height = height * ratio;
    }
    this.canvas.style.height = `${height}px`;
    const pen = picture.getContext('2d');
    pen.scale(ratio, ratio);
    pen.font = '11px system-ui, "DejaVu Sans", sans-serif';
    this.size = { width, height, ratio };
    this.x = (time) => LABEL_WIDTH + ((width - LABEL_WIDTH - 8) * time) / this.duration;
    this.y = (margin) => 6 + ((this.top - Math.max(margin, -MARGIN_BOTTOM_DEG)) / (this.top + MARGIN_BOTTOM_DEG)) * (PLOT_HEIGHT - 10);
    this.drawPlot(pen, colors);
    joints.forEach((joint, i) => this.drawStrip(pen, colors, joint, i));
    this.drawMarks(pen, colors, height);
    this.picture = picture;
    this.tellLegend(colors);
    this.seek(this.time ?? 0);
  }

  curve(pen, values, fps, color, width, dash = []) {
    pen.beginPath();
    values.forEach((value, i) => pen.lineTo(this.x(i / fps), this.y(value)));
    Object.assign(pen, { strokeStyle: color, lineWidth: width, lineJoin: 'round' });
    pen.setLineDash(dash);
    pen.stroke();
    pen.setLineDash([]);
  }

  drawPlot(pen, colors) {
    const right = this.x(this.duration);
    pen.fillStyle = colors.sunken;
    pen.fillRect(LABEL_WIDTH, 2, right - LABEL_WIDTH, PLOT_HEIGHT - 4);
    pen.fillStyle = colors.bad;
    pen.globalAlpha = 0.12;
    pen.fillRect(LABEL_WIDTH, 2, right - LABEL_WIDTH, this.y(0) - 2);
    pen.globalAlpha = 1;
    pen.fillStyle = colors.bad;
    pen.fillRect(LABEL_WIDTH, this.y(0) - 0.5, right - LABEL_WIDTH, 1);
    pen.fillStyle = colors.soft;
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    pen.fillText(`${this.top.toFixed(0)}° out`, LABEL_WIDTH - 6, 8);
    pen.fillText('edge', LABEL_WIDTH - 6, Math.max(this.y(0), 21));
    pen.fillText(`${MARGIN_BOTTOM_DEG}° in`, LABEL_WIDTH - 6, PLOT_HEIGHT - 9);
    const [motion, other] = this.motions;
    if (motion.joints.length) this.fillExcess(pen, motion.worst(), motion.joints[0].fps, colors.bad);
    if (other?.joints.length) this.curve(pen, other.worst(), other.joints[0].fps, colors.focus, 1.4, [4, 3]);
    const joint = motion.joints[this.selected];
    if (!joint) return;
    this.curve(pen, motion.worst(), joint.fps, colors.ink, 1.6);
    this.curve(pen, joint.margin, joint.fps, colors.good, 1.6);
  }

  /// Everything over the edge in red: the excess of the clip over time.
  fillExcess(pen, values, fps, color) {
    pen.beginPath();
    pen.moveTo(this.x(0), this.y(0));
    values.forEach((value, i) => pen.lineTo(this.x(i / fps), this.y(Math.max(value, 0))));
    pen.lineTo(this.x((values.length - 1) / fps), this.y(0));
    pen.fillStyle = color;
    pen.fill();
  }

  drawStrip(pen, colors, joint, i) {
    const y = PLOT_HEIGHT + 6 + i * (STRIP_HEIGHT + 2);
    const right = this.x(this.duration);
    pen.fillStyle = colors.sunken;
    pen.fillRect(LABEL_WIDTH, y, right - LABEL_WIDTH, STRIP_HEIGHT);
    joint.margin.forEach((margin, frame) => {
      const x = Math.round(this.x(frame / joint.fps));
      const next = Math.round(Math.min(this.x((frame + 1) / joint.fps), right));
      const nearness = Math.max(0, 1 + Math.min(margin, 0) / MARGIN_BOTTOM_DEG);
      pen.fillStyle = margin > OUTSIDE_DEG ? colors.bad : colors.near;
      pen.globalAlpha = margin > OUTSIDE_DEG ? 1 : 0.8 * nearness ** 3;
      pen.fillRect(x, y, next - x, STRIP_HEIGHT);
    });
    pen.globalAlpha = 1;
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    pen.font = `${i === this.selected ? '700' : '400'} 10px system-ui, "DejaVu Sans", sans-serif`;
    pen.fillStyle = i === this.selected ? colors.ink : colors.soft;
    pen.fillText(joint.name.replaceAll('_', ' '), LABEL_WIDTH - 6, y + STRIP_HEIGHT / 2);
  }

  drawMarks(pen, colors, height) {
    pen.font = '11px system-ui, "DejaVu Sans", sans-serif';
    pen.textBaseline = 'alphabetic';
    let free = -Infinity;
    for (const mark of this.motions[0].clip.marks) {
      const x = this.x(mark.time_s);
      pen.fillStyle = colors.soft;
      for (let y = 2; y < height - 16; y += 5) pen.fillRect(x - 0.5, y, 1, 2.5);
      const width = pen.measureText(mark.name).width;
      const left = Math.max(Math.min(x - width / 2, this.size.width - width - 4), LABEL_WIDTH - 10);
      if (left < free) continue;
      pen.textAlign = 'left';
      pen.fillText(mark.name, left, height - 4);
      free = left + width + 10;
    }
  }

  tellLegend(colors) {
    const entry = (color, text) => {
      const box = el('i');
      box.style.background = color;
      return el('span', {}, box, text);
    };
    const joint = this.motions[0].joints[this.selected];
    this.legend.replaceChildren(
      entry(colors.ink, 'joint nearest to its edge'),
      joint ? entry(colors.good, joint.name.replaceAll('_', ' ')) : '',
      this.motions[1] ? entry(colors.focus, 'the pinned clip') : '',
      entry(colors.near, 'near the edge of its range'),
      entry(colors.bad, 'outside'),
    );
  }

  seek(time) {
    this.time = time;
    if (!this.picture) return;
    const { height, ratio } = this.size;
    const pen = this.canvas.getContext('2d');
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.picture, 0, 0);
    pen.scale(ratio, ratio);
    const x = this.x(Math.min(time, this.duration));
    const colors = this.colors();
    pen.fillStyle = colors.ink;
    pen.fillRect(x - 1, 0, 2, height - 14);
    pen.beginPath();
    pen.arc(x, 3, 4, 0, 2 * Math.PI);
    pen.fill();
    this.track.setAttribute('aria-valuenow', time.toFixed(2));
    this.track.setAttribute('aria-valuetext', `${time.toFixed(2)} seconds`);
  }
}
