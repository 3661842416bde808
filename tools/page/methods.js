// One fixed colour, marker and dash per method, told apart without colour too. Colours are those of
// Okabe and Ito, darkened where needed to stand out on white and on black.
const method_styles = {
  'uniform': ['#808080', 'circle', [1, 3]],
  'cosine': ['#808080', 'triangle-down', [6, 3]],
  'rgl half': ['#c06a9b', 'square', []],
  'nearest outgoing': ['#c98500', 'triangle-left', [6, 3]],
  'mixture outgoing': ['#a06f00', 'diamond', []],
  'displacement outgoing': ['#0072b2', 'circle', []],
  'displacement_small outgoing': ['#2e9bd6', 'triangle-right', [6, 3]],
  'displacement half': ['#009e73', 'cross', []],
  'blend half': ['#7a5bd0', 'triangle-up', []],
  'blend outgoing': ['#6b8e23', 'triangle-up', [6, 3]],
  'compact outgoing': ['#b03060', 'circle', []],
  'compact half': ['#b03060', 'cross', [6, 3]],
  'lobes1': ['#d55e00', 'triangle-up', [1, 3]],
  'lobes2': ['#d55e00', 'diamond', [6, 3]],
  'lobes3': ['#d55e00', 'square', []],
};
const other_styles = [['#6b8e23', 'diamond', [3, 3]], ['#b03060', 'cross', [3, 3]], ['#008b8b', 'square', [3, 3]], ['#8b6f47', 'circle', [3, 3]]];
const marker_paths = {  // as Vega draws them, in a box of 2 x 2
  'circle': 'M-.8,0a.8,.8 0 1,0 1.6,0a.8,.8 0 1,0 -1.6,0Z', 'square': 'M-.7-.7H.7V.7H-.7Z', 'diamond': 'M0-1L1,0L0,1L-1,0Z',
  'cross': 'M-.3-.9H.3V-.3H.9V.3H.3V.9H-.3V.3H-.9V-.3H-.3Z', 'triangle-up': 'M-.9,.8L0-.8L.9,.8Z', 'triangle-down': 'M-.9-.8L0,.8L.9-.8Z',
  'triangle-left': 'M.8-.9L-.8,0L.8,.9Z', 'triangle-right': 'M-.8-.9L.8,0L-.8,.9Z',
};

// A method is known by its id and chart together.
const key_of = m => m.chart === 'none' ? m.id : `${m.id} ${m.chart}`;
const title_of_key = key => key.replace(/ (outgoing|half)$/, ' ($1)');
const title_of = m => m.chart === 'none' ? m.id : `${m.id} (${m.chart})`;

function style_of(key) {
  if (!method_styles[key]) {
    const used = Object.keys(method_styles).length;
    method_styles[key] = other_styles[used % other_styles.length];
  }
  const [color, shape, dash] = method_styles[key];
  return {color, shape, dash};
}

const key_mark = key => mark_html(style_of(key));

function mark_html({color, shape, dash}, line_alone = false) {
  return `<svg class="key" viewBox="-2 -1.1 4 2.2" aria-hidden="true"><path d="M-2,0H2" stroke="${color}" stroke-width=".3" ` +
    `stroke-dasharray="${dash.map(d => d / 10)}"/>${line_alone ? '' : `<path d="${marker_paths[shape]}" fill="${color}"/>`}</svg>`;
}

const mean = values => values.reduce((a, b) => a + b, 0) / values.length;

function relvar_at(m, which) {
  if (which === 'mean') return mean(m.angles.filter(a => a.theta_i_deg < 70.5).map(a => a.relvar));
  const angle = m.angles.find(a => a.theta_i_deg === Number(which));
  return angle ? angle.relvar : NaN;
}

// report.json has it too; a report of an older program does not.
const efficiency_of = m => 1 / (m.ns.sample * (relvar_at(m, 'mean') + 0.001));

function best_of(material) {
  return material.methods.reduce((best, m) => !best || efficiency_of(m) > efficiency_of(best) ? m : best, null);
}

function number(x, digits = 3) {
  if (x === null || x === undefined || Number.isNaN(x)) return '–';
  if (x !== 0 && (Math.abs(x) >= 1e5 || Math.abs(x) < 1e-4)) return x.toExponential(digits - 1);
  return String(Number(x.toPrecision(digits)));
}

function bytes_text(n) {
  if (n < 1024) return `${n} B`;
  return n < 1 << 20 ? `${number(n / 1024)} KiB` : `${number(n / (1 << 20))} MiB`;
}
