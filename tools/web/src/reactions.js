// A reaction's words and numbers: as text, as filters, as orders.

export const idOf = (reaction) => `${reaction.character}/${reaction.name}`;

const known = (value) => value !== null && value !== undefined && value !== '';
const figure = (name) => (reaction) => reaction.figures?.[name] ?? null;
const setting = (name) => (reaction) => {
  const value = reaction.settings?.[name];
  return known(value) ? String(value) : null;
};

const WORDS = { front: 0, front_left: 45, left: 90, back_left: 135, back: 180, back_right: -135, right: -90, front_right: -45 };

/// Azimuth in degrees from the front towards the character's left, and elevation; null where nothing was told.
export function directionOf(reaction) {
  const from = setting('from')(reaction);
  if (from === null) return null;
  if (from === 'above') return { azimuth: 0, elevation: 90 };
  if (from in WORDS) return { azimuth: WORDS[from], elevation: 0 };
  const [azimuth, elevation = 0] = from.split(',').map(Number);
  return Number.isFinite(azimuth) && Number.isFinite(elevation) ? { azimuth, elevation } : null;
}

/// The side that a blow comes from: front left back right above.
export function sideOf(reaction) {
  const direction = directionOf(reaction);
  if (!direction) return setting('from')(reaction);
  if (direction.elevation > 60) return 'above';
  const quarter = Math.round(direction.azimuth / 90);
  return ['front', 'left', 'back', 'right'][((quarter % 4) + 4) % 4];
}

export const targetOf = setting('hit');
export const strengthOf = (reaction) => setting('preset')(reaction) ?? setting('scene')(reaction);
export const outcomeOf = figure('outcome'); // stood, stepped, fell
export const endPoseOf = (reaction) => figure('end_pose')(reaction)?.replace('_', ' ') ?? null;
export const excessOf = figure('excess_max_deg');

/// What a card warns of, worst first.
export function troublesOf(reaction) {
  const troubles = [];
  if (reaction.status === 'failed') troubles.push({ text: 'failed', bad: true });
  if (reaction.status === 'unreadable') troubles.push({ text: 'cannot be read', bad: true });
  if (reaction.status === 'rejected') troubles.push({ text: 'rejected by the batch', bad: true });
  if (figure('over_1deg')(reaction) > 0 || excessOf(reaction) > 1) troubles.push({ text: 'over 1°', bad: true });
  if (figure('settled')(reaction) === false) troubles.push({ text: 'not settled', bad: false });
  return troubles;
}

const RESULTS = {
  settled: (reaction) => figure('settled')(reaction) === true,
  'not settled': (reaction) => figure('settled')(reaction) === false,
  'within 1°': (reaction) => excessOf(reaction) !== null && excessOf(reaction) <= 1 && !(figure('over_1deg')(reaction) > 0),
  'over 1°': (reaction) => excessOf(reaction) > 1 || figure('over_1deg')(reaction) > 0,
  failed: (reaction) => reaction.status === 'failed' || reaction.status === 'unreadable' || reaction.status === 'rejected',
};

/// Each filter: the values that a reaction has.
export const FILTERS = [
  { key: 'character', label: 'Character', all: 'All', values: (r) => [r.character] },
  { key: 'hit', label: 'Target', all: 'All', values: (r) => [targetOf(r)] },
  { key: 'from', label: 'From', all: 'All', values: (r) => [sideOf(r)] },
  { key: 'strength', label: 'Strength', all: 'All', values: (r) => [strengthOf(r)] },
  { key: 'outcome', label: 'Outcome', all: 'All', values: (r) => [outcomeOf(r)] },
  { key: 'ends', label: 'Ends', all: 'All', values: (r) => [endPoseOf(r)] },
  { key: 'result', label: 'Result', all: 'All', values: (r) => Object.keys(RESULTS).filter((name) => RESULTS[name](r)) },
];

export const VERDICTS = [
  { key: '', label: 'All' },
  { key: 'open', label: 'To judge' },
  { key: 'accept', label: 'Accepted' },
  { key: 'reject', label: 'Rejected' },
];

const collator = new Intl.Collator('en', { numeric: true });

/// Orders; `of` gives a number or a text, null goes last either way. `down`: largest first by default.
export const ORDERS = [
  { key: 'batch', label: 'As in the batch', of: (r) => r.index },
  { key: 'name', label: 'Name', of: (r) => r.name },
  { key: 'character', label: 'Character', of: (r) => r.character },
  { key: 'target', label: 'Target', of: targetOf },
  { key: 'direction', label: 'Direction', of: (r) => directionOf(r)?.azimuth ?? null },
  { key: 'strength', label: 'Strength, N s', of: figure('momentum_n_s'), down: true },
  { key: 'excess', label: 'Excess', of: excessOf, down: true },
  { key: 'score', label: 'Score', of: figure('score') },
  { key: 'steps', label: 'Steps', of: figure('steps'), down: true },
  { key: 'travel', label: 'Travel', of: figure('travel_m'), down: true },
  { key: 'rest', label: 'Time to rest', of: figure('rest_time_s'), down: true },
  { key: 'duration', label: 'Duration', of: figure('duration_s'), down: true },
  { key: 'settled', label: 'Settled', of: (r) => (figure('settled')(r) === null ? null : Number(figure('settled')(r))) },
];

export function inOrder(reactions, orderKey, down) {
  const { of } = ORDERS.find((order) => order.key === orderKey) ?? ORDERS[0];
  const sign = down ? -1 : 1;
  return reactions
    .map((reaction) => ({ reaction, value: of(reaction) }))
    .sort((a, b) => {
      if (a.value === null || b.value === null) return (a.value === null) - (b.value === null) || a.reaction.index - b.reaction.index;
      const order = typeof a.value === 'number' ? a.value - b.value : collator.compare(a.value, b.value);
      return sign * order || a.reaction.index - b.reaction.index;
    })
    .map(({ reaction }) => reaction);
}

export function matches(reaction, filters, text) {
  for (const { key, values } of FILTERS) if (filters[key] && !values(reaction).includes(filters[key])) return false;
  if (!text) return true;
  const all = `${reaction.character} ${reaction.name} ${targetOf(reaction) ?? ''} ${strengthOf(reaction) ?? ''} ${outcomeOf(reaction) ?? ''} ${endPoseOf(reaction) ?? ''} ${startOf(reaction) ?? ''}`.toLowerCase();
  return text.toLowerCase().split(/\s+/).every((word) => all.includes(word));
}

// Numbers as text; an en dash where nothing was told.
const text = (digits, unit) => (value) => (typeof value === 'number' && Number.isFinite(value) ? `${value.toFixed(digits)}${unit}` : '–');
export const degrees = text(2, '°');
export const metres = text(2, ' m');
export const millimetres = (value) => text(1, ' mm')(typeof value === 'number' ? 1000 * value : value);
export const seconds = text(2, ' s');
export const newtonSeconds = text(0, ' N s');
const joules = text(1, ' J');

/// "walk at 0.40 s", or the pose.
export function startOf(reaction) {
  const { clip, at_s: at, pose } = reaction.settings ?? {};
  if (known(clip)) return known(at) ? `${clip} at ${seconds(at)}` : String(clip);
  return known(pose) ? String(pose) : null;
}

/// Rows of the player's table: name, text, whether it is bad.
export function figuresOf(reaction) {
  const f = reaction.figures ?? {};
  const over = f.over_1deg;
  return [
    ['Excess, largest', degrees(f.excess_max_deg), f.excess_max_deg > 1],
    ['Samples over 1°', known(over) ? (known(f.samples) ? `${over} of ${f.samples}` : String(over)) : '–', over > 0],
    ['Worst joint', f.worst_joint ?? '–', false],
    ['Excess of the clip', degrees(f.clip_excess_max_deg), f.clip_excess_max_deg > 1],
    ['Outcome', [f.outcome, known(f.end_pose) && `ends ${endPoseOf(reaction)}`].filter(Boolean).join(', ') || '–', false],
    ['Steps', known(f.steps) ? String(f.steps) : '–', false],
    ['Score', text(2, '')(f.score), f.score < 0.7],
    ['Start', startOf(reaction) ?? '–', false],
    ['Momentum', newtonSeconds(f.momentum_n_s), false],
    ['Travel', metres(f.travel_m), false],
    ['Rest after', f.settled === false ? 'not settled' : seconds(f.rest_time_s), f.settled === false],
    ['Duration', seconds(f.duration_s), false],
    ['Joint separation', millimetres(f.joint_separation_max_m), f.joint_separation_max_m > 0.01],
    ['Energy gained', joules(f.energy_gain_max_j), false],
    ['Into the floor', millimetres(f.floor_penetration_max_m), f.floor_penetration_max_m > 0.01],
    ['Into itself', millimetres(f.self_penetration_max_m), false],
    ...(known(reaction.settings?.variation) ? [['Variation', `${reaction.settings.variation}, seed ${reaction.settings.seed ?? '–'}`, false]] : []),
  ];
}

/// "head · from the left · punch"
export function summaryOf(reaction) {
  const from = setting('from')(reaction);
  const side = from === null ? null : /^[-\d.]/.test(from) ? `${from.replace(',', '°, ')}°` : from.replaceAll('_', ' ');
  return [targetOf(reaction), side, strengthOf(reaction)].filter(known).join(' · ');
}
