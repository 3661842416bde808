// Vega specifications. Every function takes {material, methods (those shown), width, colors, ...}
// and returns a specification, or null where the report has no data for it.

function spec_of(o, height, parts) {
  const c = o.colors;
  return {
    $schema: 'https://vega.github.io/schema/vega/v5.json', width: o.width, height, background: c.back, padding: 5,
    autosize: {type: 'fit', contains: 'padding'},
    config: {
      axis: {labelColor: c.dim, titleColor: c.text, gridColor: c.line, domainColor: c.dim, tickColor: c.dim, gridOpacity: 0.6,
        labelFontSize: 11, titleFontSize: 12, titleFontWeight: 'normal', labelFont: 'sans-serif', titleFont: 'sans-serif'},
      text: {font: 'sans-serif'}, legend: {labelColor: c.text, labelFont: 'sans-serif', labelFontSize: 11, labelLimit: 300},
    },
    ...parts, keys: undefined, lines: undefined, usermeta: (parts.keys || []).map(k => mark_html(k, parts.lines) + k.label),
    ...(o.keys && parts.keys ? with_keys(o, parts) : {}),
  };
}

// A saved chart stands alone: it names its series. `keys` are [{label, color, shape, dash}].
function with_keys(o, {keys, lines, scales = [], autosize}) {
  const domain = keys.map(k => k.label), scale = (name, range) => ({name, type: 'ordinal', domain, range});
  const symbols = lines ? {stroke: 'key-color', strokeDash: 'key-dash', symbolType: 'stroke'} : {fill: 'key-color', shape: 'key-shape'};
  return {
    scales: [...scales, scale('key-color', keys.map(k => k.color)), scale('key-shape', keys.map(k => k.shape)), scale('key-dash', keys.map(k => k.dash))],
    legends: [{...symbols, orient: 'bottom', columns: Math.max(1, Math.floor(o.width / 190)), symbolSize: lines ? 300 : 70, symbolStrokeWidth: lines ? 2 : 0}],
    ...(autosize === 'none' ? {autosize: 'pad'} : {}),
  };
}
const keys_of = methods => methods.map(m => ({label: title_of(m), ...style_of(key_of(m))}));

// Powers of ten and, in a short domain, round numbers between them.
function log_ticks(low, high) {
  const ticks = [], decades = Math.log10(high / low);
  const factors = decades > 2.5 ? [1] : decades > 1 ? [1, 2, 5] : [1, 1.5, 2, 3, 4, 5, 7];
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e)
    for (const f of factors) if (f * 10 ** e >= low * 0.999 && f * 10 ** e <= high * 1.001) ticks.push(Number((f * 10 ** e).toPrecision(2)));
  const keep = Math.max(1, Math.ceil(ticks.length / 9));
  return ticks.filter((_, k) => k % keep === 0);
}

function log_domain(values, room = 1.3) {
  const positive = values.filter(v => v > 0);
  if (!positive.length) return [0.1, 1];
  return [Math.min(...positive) / room, Math.max(...positive) * room];
}

const log_axis = (orient, scale, domain, title) => ({orient, scale, title, grid: true, values: log_ticks(...domain), format: '~g', labelOverlap: true});

function series_of(rows) {  // facets of lines and markers
  return {facet: {name: 'series', data: rows, groupby: ['key', 'color', 'shape', 'dash']}};
}

function line_marks(data, markers = true) {
  const marks = [{type: 'line', from: {data: 'series'}, encode: {enter: {
    x: {scale: 'x', field: 'x'}, y: {scale: 'y', field: 'y'}, stroke: {field: 'color'}, strokeDash: {field: 'dash'}, strokeWidth: {value: 1.8},
    defined: {signal: 'isValid(datum.y)'}}}}];
  if (markers) marks.push({type: 'symbol', from: {data: 'series'}, encode: {enter: {
    x: {scale: 'x', field: 'x'}, y: {scale: 'y', field: 'y'}, fill: {field: 'color'}, shape: {field: 'shape'}, size: {value: 55},
    opacity: {signal: 'isValid(datum.y) ? 1 : 0'}, tooltip: {field: 'tip'}}}});
  return {type: 'group', clip: true, from: series_of(data), marks};
}

// Time against relative variance; the area of a bubble grows with the logarithm of the bytes.
function speed_accuracy(o) {
  const rows = o.methods.map(m => {
    const x = m.ns[o.time], y = Math.max(relvar_at(m, o.relvar), 1e-6);
    return {...style_of(key_of(m)), x, y, label: title_of(m), size: 70 + 45 * Math.log2(Math.max(1, m.bytes / 16)),
      tip: {method: title_of(m), time: `${number(x)} ns`, relvar: number(y), 'in memory': bytes_text(m.bytes), efficiency: number(1 / (x * (y + 0.001)))}};
  }).filter(r => r.x > 0 && Number.isFinite(r.y));
  if (!rows.length) return null;
  rows.sort((a, b) => a.x - b.x || a.y - b.y);
  const xs = log_domain(rows.map(r => r.x), 1.5), ys = log_domain(rows.map(r => r.y), 2);
  const lines = [], shares = [];
  const label = paint => ({type: 'text', from: {data: 'points'}, encode: {enter: {text: {field: 'datum.label'}, fontSize: {value: 11}, ...paint}},
    transform: [{type: 'label', size: {signal: '[width, height]'}, offset: [4], avoidMarks: ['stairs'], anchor: ['right', 'left', 'top', 'bottom', 'top-right', 'bottom-right', 'top-left', 'bottom-left']}]});
  const efficiency = (x, y) => 1 / (x * (y + 0.001));
  // Equal efficiency E: y = 1 / (E x) - 0.001, from the best method's down, two lines a decade.
  const best = Math.max(...rows.map(r => efficiency(r.x, r.y))), least = efficiency(xs[1], ys[1]);
  for (let k = 0; best * 10 ** (-k / 2) > least; ++k) {
    const e = best * 10 ** (-k / 2), on = x => 1 / (e * x) - 0.001;
    for (let n = 0; n <= 60; ++n) {
      const x = xs[0] * (xs[1] / xs[0]) ** (n / 60);
      if (on(x) > ys[0] / 20) lines.push({e, x, y: on(x)});
    }
    // Its label stands where the line enters the chart.
    const text = `${number(100 * 10 ** (-k / 2))} %`, top = ys[1] * (ys[0] / ys[1]) ** 0.06;
    if (k % 2 === 0) shares.push(on(xs[0]) < top ? {x: xs[0], y: on(xs[0]), text} : {x: 1 / (e * (top + 0.001)), y: top, text});
  }
  return spec_of(o, 400, {
    keys: keys_of(o.methods),
    data: [{name: 'rows', values: rows}, {name: 'front', values: pareto_stairs(rows, xs, ys)}, {name: 'lines', values: lines}, {name: 'shares', values: shares}],
    scales: [{name: 'x', type: 'log', domain: xs, range: 'width'}, {name: 'y', type: 'log', domain: ys, range: 'height'}],
    axes: [log_axis('bottom', 'x', xs, `${o.time_title}, ns`), log_axis('left', 'y', ys, 'relative variance')],
    marks: [
      {type: 'group', clip: true, encode: {enter: {width: {signal: 'width'}, height: {signal: 'height'}}}, marks: [
        {type: 'group', from: {facet: {name: 'iso', data: 'lines', groupby: 'e'}}, marks: [{type: 'line', from: {data: 'iso'}, encode: {enter: {
          x: {scale: 'x', field: 'x'}, y: {scale: 'y', field: 'y'}, stroke: {value: o.colors.dim}, strokeWidth: {value: 0.8}, strokeDash: {value: [2, 4]}}}}]},
        {type: 'text', from: {data: 'shares'}, encode: {enter: {x: {scale: 'x', field: 'x'}, y: {scale: 'y', field: 'y'}, text: {field: 'text'},
          fontSize: {value: 10}, fill: {value: o.colors.dim}, baseline: {value: 'bottom'}, dx: {value: 3}, dy: {value: -2}}}},
      ]},
      {type: 'line', name: 'stairs', clip: true, from: {data: 'front'}, encode: {enter: {x: {scale: 'x', field: 'x'}, y: {scale: 'y', field: 'y'},
        stroke: {value: o.colors.text}, strokeWidth: {value: 1.2}, opacity: {value: 0.7}}}},
      {type: 'symbol', name: 'points', from: {data: 'rows'}, encode: {enter: {x: {scale: 'x', field: 'x'}, y: {scale: 'y', field: 'y'}, fill: {field: 'color'},
        fillOpacity: {value: 0.8}, stroke: {value: o.colors.back}, shape: {field: 'shape'}, size: {field: 'size'}, tooltip: {field: 'tip'}}}},
      label({stroke: {value: o.colors.back}, strokeWidth: {value: 3}}), label({fill: {value: o.colors.text}}),  // a halo first
    ],
  });
}

function over_angles(o, field, title, least) {
  const rows = [];
  for (const m of o.methods) for (const a of m.angles)
    rows.push({...style_of(key_of(m)), key: key_of(m), x: a.theta_i_deg, y: Math.max(a[field], least),
      tip: {method: title_of(m), 'θi': `${a.theta_i_deg}°`, [title]: number(a[field])}});
  if (!rows.length) return null;
  const ys = log_domain(rows.map(r => r.y));
  return spec_of(o, 320, {
    keys: keys_of(o.methods),
    data: [{name: 'rows', values: rows}],
    scales: [{name: 'x', domain: [0, 90], range: 'width'}, {name: 'y', type: 'log', domain: ys, range: 'height'}],
    axes: [{orient: 'bottom', scale: 'x', title: 'θi, degrees', values: [0, 15, 30, 45, 60, 75, 90], grid: true}, log_axis('left', 'y', ys, title)],
    marks: [line_marks('rows')],
  });
}

const relvar_over_angles = o => over_angles(o, 'relvar', 'relative variance', 1e-6);
const worst_over_angles = o => over_angles(o, 'max_weight', 'worst weight / mean', 1);

function curve_of(owner, theta_i) { return (owner.curves || []).find(c => c.theta_i_deg === theta_i); }

function weight_histogram(o) {
  const rows = [];
  for (const m of o.methods) {
    const curve = curve_of(m, o.theta_i);
    if (!curve) continue;
    const {shares} = curve.weights, step = 3 / shares.length;
    // A stair, closed at both ends; empty bins are no line on a logarithmic axis.
    const points = shares.map((y, k) => ({x: 10 ** (-1.5 + k * step), x2: 10 ** (-1.5 + (k + 1) * step), y: y > 0 ? y : 3e-5}));
    for (const p of points) for (const x of [p.x, p.x2]) rows.push({...style_of(key_of(m)), key: key_of(m), x, y: p.y});
  }
  if (!rows.length) return null;
  const xs = [10 ** -1.5, 10 ** 1.5], ys = [5e-5, 1];
  return spec_of(o, 320, {
    keys: keys_of(o.methods), lines: true,
    data: [{name: 'rows', values: rows}],
    scales: [{name: 'x', type: 'log', domain: xs, range: 'width'}, {name: 'y', type: 'log', domain: ys, range: 'height'}],
    axes: [{...log_axis('bottom', 'x', xs, 'weight / mean weight'), values: [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20]}, {...log_axis('left', 'y', ys, 'share of draws'), format: '~p'}],
    marks: [line_marks('rows', false)],
  });
}

// Goniometric diagram in the plane of incidence: light from the right, mirror direction on the left.
function polar_diagram(o) {
  const table = curve_of(o.material, o.theta_i);
  if (!table) return null;
  const curves = [{key: 'table', label: 'table', color: o.colors.text, shape: 'circle', dash: [], strokeWidth: 7, values: table.table}];
  const add = (key, label, strokeWidth, values) => values && curves.push({...style_of(key), key, label, strokeWidth, values});
  const lobes = o.methods.map(m => m.id).filter(id => /^lobes\d$/.test(id));
  for (const m of o.methods) {
    const stack = ['displacement', 'blend', 'compact'].includes(m.id);
    if (o.diagram === 'pdf' || stack) add(key_of(m), title_of(m), 1.6, (curve_of(m, o.theta_i) || {}).pdf);
  }
  if (o.diagram === 'fits')
    (o.material.fits || []).forEach((fit, k) => {
      if (lobes.includes(`lobes${k + 1}`)) add(`lobes${k + 1}`, `fit of ${k + 1}`, 2, (curve_of(fit, o.theta_i) || {}).model);
    });
  const peak = Math.max(...table.table) * 1.15, decades = 4;
  if (!(peak > 0)) return null;
  const radius = {
    log: d => d > 0 ? Math.max(0, 1 + Math.log10(d / peak) / decades) : 0,
    linear: d => d / peak,
    root: d => Math.sqrt(Math.max(d, 0) / peak),
  }[o.radial];
  const rows = [], rings = [], spokes = [], labels = [];
  for (const c of curves) c.values.forEach((d, k) => {
    const r = Math.min(radius(d), 1.06), t = table.theta_o_deg[k] * Math.PI / 180;
    rows.push({key: c.key, color: c.color, dash: c.dash, strokeWidth: c.strokeWidth, x: -r * Math.sin(t), y: r * Math.cos(t)});
  });
  const values = o.radial === 'log' ? [1, 2, 3].map(k => 10 ** Math.floor(Math.log10(peak) - k + 1)) : [0.25, 0.5, 0.75, 1].map(f => f * peak / 1.15);
  for (const value of values) {
    const r = radius(value);
    for (let t = -90; t <= 90; t += 3) rings.push({ring: value, x: r * Math.sin(t * Math.PI / 180), y: r * Math.cos(t * Math.PI / 180)});
    labels.push({x: r, y: -0.02, text: number(value, 2), baseline: 'top'});
  }
  for (let t = -90; t <= 90; t += 3) rings.push({ring: 'edge', x: Math.sin(t * Math.PI / 180), y: Math.cos(t * Math.PI / 180)});
  for (let t = -90; t <= 90; t += 30) {
    const x = Math.sin(t * Math.PI / 180), y = Math.cos(t * Math.PI / 180);
    spokes.push({x, y});
    if (Math.abs(t) < 90) labels.push({x: 1.06 * x, y: 1.06 * y, text: `${Math.abs(t)}°`, baseline: 'middle'});
  }
  const t_in = o.theta_i * Math.PI / 180;
  const width = o.width, unit = Math.min(width / 2.3, 330);
  const height = Math.round(unit * 1.25);
  const at = (x, y) => ({x: {signal: `width / 2 + ${unit} * ${x}`}, y: {signal: `${unit * 1.12} - ${unit} * ${y}`}});
  return spec_of({...o, width}, height, {
    autosize: 'none',
    keys: curves, lines: true,
    data: [{name: 'rows', values: rows}, {name: 'rings', values: rings}, {name: 'spokes', values: spokes}, {name: 'labels', values: labels}],
    marks: [
      {type: 'group', from: {facet: {name: 'ring', data: 'rings', groupby: 'ring'}}, marks: [{type: 'line', from: {data: 'ring'}, encode: {enter: {
        ...at('datum.x', 'datum.y'), stroke: {value: o.colors.line}, strokeWidth: {value: 1}}}}]},
      {type: 'rule', from: {data: 'spokes'}, encode: {enter: {...at('0', '0'), x2: at('datum.x', '0').x, y2: at('0', 'datum.y').y, stroke: {value: o.colors.line}}}},
      {type: 'text', from: {data: 'labels'}, encode: {enter: {...at('datum.x', 'datum.y'), text: {field: 'text'}, align: {value: 'center'},
        baseline: {field: 'baseline'}, fontSize: {value: 11}, fill: {value: o.colors.dim}}}},
      {type: 'group', from: {facet: {name: 'series', data: 'rows', groupby: ['key', 'color', 'dash', 'strokeWidth']}}, marks: [{type: 'line', from: {data: 'series'}, encode: {enter: {
        ...at('datum.x', 'datum.y'), stroke: {field: 'color'}, strokeDash: {field: 'dash'}, strokeWidth: {field: 'strokeWidth'},
        strokeOpacity: {signal: "datum.key === 'table' ? 0.28 : 1"}, strokeJoin: {value: 'round'}}}}]},
      {type: 'rule', encode: {enter: {...at(String(Math.sin(t_in)), String(Math.cos(t_in))), x2: at('0', '0').x, y2: at('0', '0').y,
        stroke: {value: o.colors.text}, strokeDash: {value: [4, 4]}}}},
      {type: 'text', encode: {enter: {...at(String(1.02 * Math.sin(t_in)), String(1.02 * Math.cos(t_in))), text: {value: 'wi'}, fontStyle: {value: 'italic'},
        align: {value: 'left'}, baseline: {value: 'bottom'}, fontSize: {value: 13}, fill: {value: o.colors.text}}}},
    ],
  });
}

// The (u, v) grid on the flattened hemisphere (Havran et al. 2003, Fig. 6), over the density.
function grid_on_hemisphere(o) {
  const method = o.material.methods.find(m => key_of(m) === o.grid_method);
  const curves = method ? (method.curves || []).filter(c => c.grid) : [];
  if (!curves.length) return null;
  const columns = o.width > 560 ? 4 : 2, rows = Math.ceil(curves.length / columns);
  const cell = o.width / columns, radius = cell / 2 - 6;
  const shades = [], lines = [], labels = [];
  curves.forEach((curve, k) => {
    const x = cell * (k % columns + 0.5), y = (cell + 24) * Math.floor(k / columns) + cell / 2;
    labels.push({x, y: y + cell / 2 + 8, text: `θi = ${curve.theta_i_deg}°`});
    const {sectors, rings, levels} = curve_of(o.material, curve.theta_i_deg).disk;
    const bands = {};  // one path for each tenth of the scale
    levels.forEach((level, n) => {
      const band = Math.round(level / 10) + 10;
      if (band <= 0) return;
      const i = Math.floor(n / rings), j = n % rings, r0 = radius * j / rings, r1 = radius * (j + 1) / rings;
      for (const sign of [-1, 1]) {
        const [a, b] = [i, i + 1].map(s => sign * Math.PI * s / sectors);
        const corner = (r, t) => `${(r * Math.cos(t)).toFixed(1)},${(-r * Math.sin(t)).toFixed(1)}`;
        bands[band] = (bands[band] || '') + `M${corner(r0, a)}L${corner(r1, a)}L${corner(r1, b)}L${corner(r0, b)}Z`;
      }
    });
    for (const [band, path] of Object.entries(bands)) shades.push({x, y, path, opacity: band / 10 * 0.75});
    const path = curve.grid.replace(/-?\d+/g, n => (n * radius / 1000).toFixed(2));
    lines.push({x, y, path, radius});
  });
  const place = {x: {field: 'x'}, y: {field: 'y'}, path: {field: 'path'}};
  return spec_of(o, rows * (cell + 24), {
    autosize: 'none', padding: 0,
    data: [{name: 'shades', values: shades}, {name: 'lines', values: lines}, {name: 'labels', values: labels}],
    marks: [
      {type: 'path', from: {data: 'shades'}, encode: {enter: {...place, fill: {value: o.colors.shade}, fillOpacity: {field: 'opacity'}}}},
      {type: 'path', from: {data: 'lines'}, encode: {enter: {...place, stroke: {value: o.colors.grid}, strokeWidth: {value: 0.7}}}},
      {type: 'symbol', from: {data: 'lines'}, encode: {enter: {x: {field: 'x'}, y: {field: 'y'}, size: {signal: 'PI * datum.radius * datum.radius * 4 / PI'},
        shape: {value: 'circle'}, stroke: {value: o.colors.dim}, fill: {value: 'transparent'}}}},
      {type: 'text', from: {data: 'labels'}, encode: {enter: {x: {field: 'x'}, y: {field: 'y'}, text: {field: 'text'}, align: {value: 'center'},
        baseline: {value: 'middle'}, fontSize: {value: 12}, fill: {value: o.colors.text}}}},
    ],
  });
}

function convergence(o) {
  const rows = [], random = [];
  for (const m of o.methods) {
    const style = style_of(key_of(m));
    (m.qmc_error || []).forEach((y, k) => y > 0 && rows.push({...style, key: key_of(m), x: 16 * 2 ** k, y,
      tip: {method: title_of(m), points: 16 * 2 ** k, "Sobol' error": number(y), slope: number(m.qmc_slope, 2)}}));
    (m.mc_error || []).forEach((y, k) => y > 0 && random.push({color: style.color, key: key_of(m), x: 16 * 2 ** k, y}));
  }
  if (!rows.length) return null;
  const xs = log_domain(rows.map(r => r.x), 1.1), ys = log_domain(rows.concat(random).map(r => r.y));
  return spec_of(o, 320, {
    keys: keys_of(o.methods),
    data: [{name: 'rows', values: rows}, {name: 'random', values: random}],
    scales: [{name: 'x', type: 'log', domain: xs, range: 'width'}, {name: 'y', type: 'log', domain: ys, range: 'height'}],
    axes: [{...log_axis('bottom', 'x', xs, 'samples'), format: '~s'}, log_axis('left', 'y', ys, 'relative error')],
    marks: [
      {type: 'group', clip: true, from: {facet: {name: 'walk', data: 'random', groupby: ['key', 'color']}}, marks: [{type: 'line', from: {data: 'walk'}, encode: {enter: {
        x: {scale: 'x', field: 'x'}, y: {scale: 'y', field: 'y'}, stroke: {field: 'color'}, strokeWidth: {value: 0.8}, strokeOpacity: {value: 0.5}, strokeDash: {value: [2, 2]}}}}]},
      line_marks('rows'),
    ],
  });
}

// Efficiency of every method over the material's best, a row for each material.
function overview_chart(o) {
  const rows = [];
  for (const material of o.report.materials) {
    const best = best_of(material);
    if (!best) continue;
    for (const m of material.methods) {
      if (o.hidden.has(key_of(m))) continue;
      const x = efficiency_of(m) / efficiency_of(best);
      rows.push({...style_of(key_of(m)), x: Math.max(x, 1e-5), material: material.name, tip: {material: material.name, method: title_of(m), efficiency: `${number(100 * x)} % of the best`}});
    }
  }
  if (!rows.length) return null;
  const names = [...new Set(rows.map(r => r.material))], xs = [Math.min(0.1, ...rows.map(r => r.x)) / 1.3, 1.25];
  const shown = new Map();
  for (const m of o.report.materials.flatMap(material => material.methods)) if (!o.hidden.has(key_of(m))) shown.set(key_of(m), m);
  return spec_of(o, 60 + 26 * names.length, {
    keys: keys_of([...shown.values()]),
    data: [{name: 'rows', values: rows}],
    scales: [{name: 'x', type: 'log', domain: xs, range: 'width'}, {name: 'y', type: 'point', domain: names, range: 'height', padding: 0.5}],
    axes: [{...log_axis('bottom', 'x', xs, 'efficiency / best'), values: log_ticks(xs[0], 1)},
      {orient: 'left', scale: 'y', grid: true, labelLimit: o.width / 3}],
    marks: [{type: 'symbol', from: {data: 'rows'}, encode: {enter: {x: {scale: 'x', field: 'x'}, y: {scale: 'y', field: 'material'}, fill: {field: 'color'},
      shape: {field: 'shape'}, size: {value: 90}, fillOpacity: {value: 0.85}, stroke: {value: o.colors.back}, tooltip: {field: 'tip'}}}}],
  });
}

// What quality costs in memory: relative variance and the error of evaluation against bytes. `front` of a
// material: [{id, bytes, ns, relvar, eval_error, chosen}].
function memory_front(o) {
  const points = (o.material.front || []).filter(p => p.bytes > 0).map(p => ({...p, id: p.id.replace('/', ' ')}));
  const panels = [{field: 'relvar', title: 'relative variance'}, {field: 'eval_error', title: 'evaluation error'}]
    .map(panel => ({...panel, points: points.filter(p => p[panel.field] > 0)})).filter(panel => panel.points.length);
  if (!panels.length) return null;
  const columns = o.width > 560 ? panels.length : 1, left = 66, gap = 16, height = 260, below = 50, above = 12;
  const width = o.width / columns - left - gap, xs = log_domain(points.map(p => p.bytes), 1.6);
  const ids = [...new Set(points.map(p => p.id))];
  const groups = panels.map((panel, k) => {
    const rows = panel.points.map(p => ({...style_of(p.id), x: p.bytes, y: p[panel.field], label: p.chosen ? 'kept' : '', chosen: Boolean(p.chosen),
      tip: {method: title_of_key(p.id), 'in memory': bytes_text(p.bytes), [panel.title]: number(p[panel.field]), ...(p.ns ? {time: `${number(p.ns)} ns`} : {}), ...(p.chosen ? {chosen: 'yes'} : {})}}));
    rows.sort((a, b) => a.x - b.x || a.y - b.y);
    const ys = log_domain(rows.map(r => r.y), 1.8), at = {x: {scale: 'x', field: 'x'}, y: {scale: 'y', field: 'y'}};
    const label = paint => ({type: 'text', from: {data: 'points'}, encode: {enter: {text: {field: 'datum.label'}, fontSize: {value: 11}, ...paint}},
      transform: [{type: 'label', size: [width, height], offset: [10], avoidMarks: ['stairs'], anchor: ['top-right', 'bottom-left', 'right', 'left', 'top', 'bottom']}]});
    return {
      type: 'group', encode: {enter: {x: {value: left + (k % columns) * (left + width + gap)}, y: {value: above + Math.floor(k / columns) * (height + below + above)},
        width: {value: width}, height: {value: height}}},
      signals: [{name: 'width', value: width}, {name: 'height', value: height}],
      data: [{name: 'rows', values: rows}, {name: 'front', values: pareto_stairs(rows, xs, ys)}, {name: 'chosen', values: rows.filter(r => r.chosen)}],
      scales: [{name: 'x', type: 'log', domain: xs, range: [0, width]}, {name: 'y', type: 'log', domain: ys, range: [height, 0]}],
      axes: [{...log_axis('bottom', 'x', xs, 'in memory, KiB'), values: log_ticks(xs[0] / 1024, xs[1] / 1024).map(t => 1024 * t), format: undefined,
        encode: {labels: {update: {text: {signal: "format(datum.value / 1024, '~g')"}}}}}, log_axis('left', 'y', ys, panel.title)],
      marks: [
        {type: 'line', name: 'stairs', clip: true, from: {data: 'front'}, encode: {enter: {...at, stroke: {value: o.colors.text}, strokeWidth: {value: 1.2}, opacity: {value: 0.7}}}},
        {type: 'symbol', from: {data: 'chosen'}, encode: {enter: {...at, size: {value: 420}, stroke: {value: o.colors.text}, strokeWidth: {value: 2}, fill: {value: 'transparent'}}}},
        {type: 'symbol', name: 'points', from: {data: 'rows'}, encode: {enter: {...at, fill: {field: 'color'}, shape: {field: 'shape'}, size: {value: 90},
          stroke: {value: o.colors.back}, tooltip: {field: 'tip'}}}},
        label({stroke: {value: o.colors.back}, strokeWidth: {value: 3}}), label({fill: {value: o.colors.text}}),
      ],
    };
  });
  return spec_of(o, Math.ceil(panels.length / columns) * (height + below + above), {
    autosize: 'none', padding: 0, keys: ids.map(id => ({label: title_of_key(id), ...style_of(id)})), marks: groups,
  });
}

// Of points sorted by x: the front of those that no other beats in both, as a stair over the chart.
function pareto_stairs(rows, xs, ys) {
  const front = [];
  for (const r of rows) if (!front.length || r.y < front[front.length - 1].y) front.push(r);
  const stairs = [];
  front.forEach((r, k) => { stairs.push({x: r.x, y: k ? front[k - 1].y : ys[1]}, {x: r.x, y: r.y}); });
  stairs.push({x: xs[1], y: front[front.length - 1].y});
  return stairs;
}
