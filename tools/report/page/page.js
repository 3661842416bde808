// Puts the report on the page: tables once, charts when their material is looked at.
const report = JSON.parse(document.getElementById('report').textContent);
const element = id => document.getElementById(id);
const escaped = text => String(text).replace(/[&<>"]/g, c => ({'&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;'}[c]));
const dark_theme = matchMedia('(prefers-color-scheme: dark)');

const state = {material: 0, theta_i: 50, hidden: new Set(), time: 'sample', relvar: 'mean', radial: 'log', diagram: 'fits', variant: null, grid_method: null, printing: false};

const light_colors = {back: '#ffffff', text: '#1b1f24', dim: '#57606a', line: '#d0d7de', shade: '#2166ac', grid: '#b2182b'};
const dark_colors = {back: '#14171a', text: '#e6e9ec', dim: '#a0a8b0', line: '#3a4148', shade: '#4393c3', grid: '#ffb08a'};
const colors = () => dark_theme.matches && !state.printing ? dark_colors : light_colors;

const time_titles = {sample: 'sample', pdf: 'pdf', eval: 'eval', sample_batch: 'sample, batch', pdf_batch: 'pdf, batch', eval_batch: 'eval, batch'};
const time_title = time => time_titles[time] || time;

// The charts of a material: file name, specification, title, what it shows, and its own controls.
const charts = [
  {id: 'speed-accuracy', wide: true, make: speed_accuracy, title: 'Speed against accuracy', tools: ['time', 'relvar'],
    text: 'Lower left is better. Solid line: the Pareto front. Dotted lines: equal efficiency, two a decade down from the best method, at 100 %. The area of a marker grows with the logarithm of the bytes in memory.'},
  {id: 'front', wide: true, make: memory_front, needs: material => (material.front || []).length, title: 'What memory buys',
    text: 'Relative variance and the error of evaluation against memory. Compact BSDFs need no table, and their error is against it. Fitted lobes draw for the table, which their relative variance needs; the error is that of the model alone. Line: the Pareto front. Ringed: the one that is kept.'},
  {id: 'relvar', make: relvar_over_angles, title: 'Relative variance over the incident angle', text: 'The number of samples for a given noise is in proportion to it.'},
  {id: 'worst-weight', make: worst_over_angles, title: 'Worst weight over the incident angle', text: 'The brightest firefly of 65,536 draws, over the mean.'},
  {id: 'weights', make: weight_histogram, title: 'Weights', angle: true, text: 'Shares of 16,384 draws in bins a fortieth of a decade wide; the outer bins take what is beyond. A perfect sampler has all weights at 1.'},
  {id: 'convergence', make: convergence, title: 'Convergence at 40°', text: "Error of the radiance reflected from a smooth environment: solid with scrambled Sobol' points, dotted with random ones."},
  {id: 'goniometric', wide: true, make: polar_diagram, title: 'Goniometric diagram in the plane of incidence', angle: true, tools: ['diagram', 'radial'],
    text: 'Grey, wide: the table, f<sub>r</sub> cos θ<sub>o</sub> over its albedo, in 1/sr. Stacks and pdfs: the density of the draws. Fits: f<sub>r</sub> cos θ<sub>o</sub> of the fitted lobes over the albedo of the table. Light comes from the right; the mirror direction is on the left.'},
  {id: 'grid', wide: true, make: grid_on_hemisphere, title: 'The unit square on the hemisphere', tools: ['grid_method'],
    text: 'A 16 × 16 grid of (u,v) carried to the hemisphere, seen from above (r² = 1 − cos θ<sub>o</sub>), over the density of the table (logarithmic, three decades). Light comes from the right.'},
];

const options_of = pairs => pairs.map(([value, text]) => `<option value="${escaped(value)}">${escaped(text)}</option>`).join('');

const times_of = material => {
  const found = new Set(material.methods.flatMap(m => Object.keys(m.ns)));
  return [...new Set([...Object.keys(time_titles), ...found])].filter(t => found.has(t));
};
const hash_text = file => file.sha256 ? `, SHA-256 ${escaped(file.sha256)}` : '';

function tool_html(tool, material) {
  const all_times = times_of(material);
  const angles = material.methods[0].angles.map(a => [a.theta_i_deg, `${a.theta_i_deg}°`]);
  const [label, options] = {
    time: ['Time of', all_times.map(t => [t, time_title(t)])],
    relvar: ['relvar', [['mean', 'mean 2°–70°'], ...angles]],
    radial: ['Radius', [['log', 'logarithmic'], ['root', 'square root'], ['linear', 'linear']]],
    diagram: ['Curves', [['fits', 'table, stacks, fitted lobes'], ['pdf', 'table, pdfs of all methods']]],
    grid_method: ['Method', material.methods.filter(m => (m.curves || []).some(c => c.grid)).map(m => [key_of(m), title_of(m)])],
  }[tool];
  return `<label>${label} <select data-tool="${tool}">${options_of(options)}</select></label>`;
}

// Below which a chi-square p is too small for chance: 1 % for the whole report.
const significance = (() => {
  const tests = report.materials.flatMap(m => m.methods).reduce((n, m) => n + m.angles.length, 0);
  return 1 - 0.99 ** (1 / Math.max(tests, 1));
})();

const default_mark = m => m.params.default ? ' <abbr title="what Sampler builds of a table by default">default</abbr>' : '';

function methods_table(material) {
  const best = best_of(material), times = times_of(material);
  const rows = material.methods.map(m => {
    const worst = Math.max(...m.angles.map(a => a.max_weight)), p = Math.min(...m.angles.map(a => a.chi2_p));
    const invalid = Math.max(...m.angles.map(a => a.invalid_fraction));
    const cells = [bytes_text(m.bytes), number(m.build_seconds, 2), ...times.map(t => number(m.ns[t])),
      number(relvar_at(m, 'mean'), 2), `${number(100 * efficiency_of(m) / efficiency_of(best))} %`, number(worst), number(100 * invalid, 2) + ' %',
      p < significance ? `<strong>${number(p, 2)}</strong>` : number(p, 2), number(m.qmc_slope, 2), number(m.coherence.stretch_p99), m.coherence.tears];
    return `<tr${m === best ? ' class="best"' : ''}><td>${key_mark(key_of(m))}${escaped(title_of(m))}${default_mark(m)}</td>${cells.map(c => `<td>${c}</td>`).join('')}</tr>`;
  });
  const heads = ['method', 'in memory', 'build, s', ...times.map(t => `${time_title(t)}, ns`), 'mean relvar', 'efficiency', 'worst weight', 'invalid, max', 'χ² p, min',
    "Sobol' slope", 'stretch', 'tears'];
  return `<table><thead><tr>${heads.map(h => `<th scope="col">${h}</th>`).join('')}</tr></thead><tbody>${rows.join('')}</tbody></table>`;
}

function fits_table(material) {
  if (!material.fits || !material.fits.length) return '';
  const short = text => text.replace(/\d+\.\d{4,}(e-?\d+)?/g, x => String(Number(Number(x).toPrecision(4))));
  const rows = material.fits.map(f => {
    const e = part => ['cosine_rms', 'log_rms', 'relative_l1', 'albedo', 'delta_e_2000'].map(k => `<td>${number(f.errors[part][k])}</td>`).join('');
    return `<tr><td class="wrap">${escaped(short(f.model))}</td>${e('inside_cutoff')}${e('beyond_cutoff')}</tr>`;
  });
  const heads = ['RMS', 'log RMS', 'L1', 'albedo', 'ΔE'];
  return `<h3>Fitted lobes</h3><div class="scroll"><table><thead><tr><th scope="col">model</th>${heads.concat(heads.map(h => h + ' beyond')).map(h => `<th scope="col">${h}</th>`).join('')}` +
    `</tr></thead><tbody>${rows.join('')}</tbody></table></div>`;
}

function figure_html(chart, file, tools) {
  return `<figure class="${chart.wide ? 'wide' : ''}" data-chart="${chart.id}" data-file="${escaped(file)}">` +
    `<div class="tools"><h3>${chart.title}<span class="at"></span></h3>${tools}<span class="save"><button type="button" data-save="svg" aria-label="${chart.title} as SVG">SVG</button> ` +
    `<button type="button" data-save="png" aria-label="${chart.title} as PNG">PNG</button></span></div><div class="chart"></div><div class="keys" aria-hidden="true"></div><figcaption>${chart.text}</figcaption></figure>`;
}

function material_html(material, k) {
  const figures = charts.filter(c => !c.needs || c.needs(material)).map(c => figure_html(c, `${material.name}_${c.id}`, (c.tools || []).map(t => tool_html(t, material)).join('')));
  return `<section class="material" id="material-${k}" hidden aria-labelledby="title-${k}"><h2 id="title-${k}">${escaped(material.name)}</h2>` +
    (material.verdict ? `<p class="verdict">${escaped(material.verdict)}</p>` : '') +
    `<p class="provenance">${escaped(material.format)} file of ${bytes_text(material.source_bytes)} on disk: ${escaped(material.source)}${hash_text(material)}. ` +
    `Measured by gonio ${escaped(report.gonio_version)} on ${escaped(report.machine.cpu)}, ${report.machine.threads} threads, ${escaped(report.machine.compiler)}.</p>` +
    `<div class="charts">${figures.join('')}</div><h3>Methods</h3><div class="scroll methods" tabindex="0" role="region" aria-label="Methods">${methods_table(material)}</div>${fits_table(material)}</section>`;
}

function provenance_html() {
  const facts = [];
  if (report.command) facts.push(['Command', `<code>${escaped(report.command)}</code>`]);
  if (report.seeds) facts.push(['Seeds', Object.entries(report.seeds).map(([what, seed]) => `${escaped(what)} ${seed}`).join(', ')]);
  const files = [...report.materials, ...(report.lights || [])];
  if (files.some(f => f.sha256)) facts.push(['Inputs', `<ul>${files.map(f => `<li>${escaped(f.source)}, ${bytes_text(f.source_bytes)} on disk${hash_text(f)}</li>`).join('')}</ul>`]);
  return facts.length ? `<details><summary>Where the figures come from</summary><dl>${facts.map(([what, text]) => `<dt>${what}</dt><dd>${text}</dd>`).join('')}</dl></details>` : '';
}

function overview_table() {
  const rows = report.materials.map((material, k) => {
    const best = best_of(material);
    if (!best) return '';
    const lobes = material.lobes_against_stack;
    const verdict = lobes ? (lobes.enough ? `yes, ${lobes.lobes}` : `no, ${number(lobes.equal_time_ratio, 2)}× the variance at equal time`) : '–';
    const cells = [number(best.ns.sample), number(relvar_at(best, 'mean'), 2), number(Math.max(...best.angles.map(a => a.max_weight))), bytes_text(best.bytes)];
    return `<tr><td><a href="#material-${k}">${escaped(material.name)}</a></td><td class="left">${escaped(material.format)}</td><td class="left">${key_mark(key_of(best))}${escaped(title_of(best))}</td>` +
      `${cells.map(c => `<td>${c}</td>`).join('')}<td class="left">${verdict}</td></tr>`;
  });
  return '<table><thead><tr><th scope="col">material</th><th scope="col" class="left">format</th><th scope="col" class="left">most efficient</th><th scope="col">sample, ns</th><th scope="col">mean relvar</th>' +
    `<th scope="col">worst weight</th><th scope="col">in memory</th><th scope="col" class="left">a lobe fit enough?</th></tr></thead><tbody>${rows.join('')}</tbody></table>`;
}

function lights_html() {
  return (report.lights || []).map(light => `<section><h2>${escaped(light.name)}</h2><p class="provenance">${escaped(light.format)}: ${escaped(light.source)}${hash_text(light)}, ${number(light.flux, 6)} lm</p>` +
    '<div class="scroll"><table><thead><tr><th scope="col">method</th><th scope="col">flux, lm</th><th scope="col">relvar</th><th scope="col">ns a draw</th></tr></thead><tbody>' +
    light.methods.map(m => `<tr><td>${escaped(m.id)}</td><td>${number(m.flux, 6)}</td><td>${number(m.relvar, 2)}</td><td>${number(m.ns.sample)}</td></tr>`).join('') +
    '</tbody></table></div></section>').join('');
}

// --- Charts

function specification(figure, width, palette, keys = false) {
  const id = figure.dataset.chart;
  if (id === 'overview') return overview_chart({report, hidden: state.hidden, width, colors: palette, keys});
  const material = report.materials[Number(figure.closest('section').id.slice('material-'.length))];
  const methods = material.methods.filter(m => !state.hidden.has(key_of(m)));
  return charts.find(c => c.id === id).make({...state, material, methods, width, colors: palette, keys, time_title: time_title(state.time)});
}

const views = new Map();

function draw(figure) {
  const box = figure.querySelector('.chart');
  const width = state.printing ? (figure.matches('.wide') ? 700 : 340) : Math.floor(box.clientWidth);
  const spec = specification(figure, width, colors());
  if (views.has(figure)) views.get(figure).finalize();
  views.delete(figure);
  figure.querySelectorAll('[data-save]').forEach(button => { button.disabled = !spec; });
  const at = figure.querySelector('.at');
  if (at) at.textContent = (charts.find(c => c.id === figure.dataset.chart) || {}).angle ? ` at θi = ${state.theta_i}°` : '';
  if (!spec) {
    box.innerHTML = '<p class="empty">No method with data for this chart.</p>';
    return;
  }
  box.textContent = '';
  figure.querySelector('.keys').innerHTML = (spec.usermeta || []).map(k => `<span>${k}</span>`).join('');
  const view = new vega.View(vega.parse(spec), {renderer: 'svg', container: box, hover: false});
  view.description(figure.querySelector('h3').textContent).run();
  views.set(figure, view);
}

function visible_figures() {
  return [...document.querySelectorAll('figure')].filter(f => state.printing || !f.closest('[hidden]'));
}

// Charts below the window are drawn when they come near it.
const near = new IntersectionObserver(entries => {
  for (const entry of entries) {
    if (!entry.isIntersecting) continue;
    near.unobserve(entry.target);
    draw(entry.target);
  }
}, {rootMargin: '250px'});

function redraw(filter = () => true) {
  for (const figure of visible_figures().filter(filter)) {
    near.unobserve(figure);
    near.observe(figure);
  }
}

// For papers: on white, 640 wide, whatever the window is.
async function save(figure, format) {
  const view = new vega.View(vega.parse(specification(figure, 640, light_colors, true)), {renderer: 'none'});
  await view.runAsync();
  const link = document.createElement('a');
  link.href = await view.toImageURL(format, format === 'png' ? 2 : 1);
  link.download = `${figure.dataset.file}.${format}`;
  link.click();
  view.finalize();
}

// --- Controls

function show_material(k) {
  state.material = k;
  element('material').value = String(k);
  report.materials.forEach((_, n) => { element(`material-${n}`).hidden = n !== k; });
  element('previous').disabled = k === 0;
  element('next').disabled = k === report.materials.length - 1;
  const keys = [...element(`material-${k}`).querySelectorAll('[data-tool=grid_method] option')].map(o => o.value);
  if (!keys.includes(state.grid_method)) state.grid_method = keys.find(key => key.startsWith('displacement')) || keys[0] || null;
  show_tools();
  redraw();
}

function show_tools() {
  document.querySelectorAll('[data-tool]').forEach(select => { select.value = state[select.dataset.tool]; });
}

function set_hidden(hidden) {
  state.hidden = hidden;
  document.querySelectorAll('[data-method]').forEach(box => { box.checked = !hidden.has(box.dataset.method); });
  redraw();
}

function start() {
  const {machine} = report;
  element('machine').textContent = `gonio ${report.gonio_version}, ${machine.cpu}, ${machine.compiler}, ${machine.threads} threads`;
  element('provenance').innerHTML = provenance_html();
  element('lights').innerHTML = lights_html();
  element('stability').innerHTML = stability_html();
  if (element('variant')) element('variant').addEventListener('change', event => { element('variant-rows').innerHTML = variant_table(event.target.value); });
  if (!report.materials.length) {
    element('overview').hidden = element('controls').hidden = true;
    return;
  }
  const keys = new Map();
  for (const m of report.materials.flatMap(material => material.methods)) if (!keys.has(key_of(m)) || m.params.default) keys.set(key_of(m), m);
  element('methods').innerHTML = [...keys].map(([key, m]) => `<label><input type="checkbox" checked data-method="${escaped(key)}">${key_mark(key)}${escaped(title_of(m))}${default_mark(m)}</label>`).join('');
  element('material').innerHTML = options_of(report.materials.map((m, k) => [k, m.name]));
  const angles = (report.materials[0].curves || []).map(c => c.theta_i_deg);
  if (angles.length && !angles.includes(state.theta_i)) state.theta_i = angles[0];
  element('angle').innerHTML = options_of(angles.map(a => [a, `${a}°`]));
  element('angle').value = String(state.theta_i);
  element('overview-table').innerHTML = overview_table();
  if (report.materials.length > 1)
    element('overview-chart').innerHTML = figure_html({id: 'overview', wide: true, title: 'Efficiency by material', text: 'Further right is better; the best of each material is at 1.'}, 'overview', '');
  element('materials').innerHTML = report.materials.map(material_html).join('');
  if (innerWidth < 768) element('methods-box').open = false;

  element('controls').addEventListener('submit', event => event.preventDefault());
  element('material').addEventListener('change', event => show_material(Number(event.target.value)));
  element('previous').addEventListener('click', () => show_material(state.material - 1));
  element('next').addEventListener('click', () => show_material(state.material + 1));
  element('angle').addEventListener('change', event => {
    state.theta_i = Number(event.target.value);
    redraw(f => (charts.find(c => c.id === f.dataset.chart) || {}).angle);
  });
  element('methods').addEventListener('change', () => {
    set_hidden(new Set([...document.querySelectorAll('[data-method]')].filter(box => !box.checked).map(box => box.dataset.method)));
  });
  element('all').addEventListener('click', () => set_hidden(new Set()));
  element('stacks').addEventListener('click', () => set_hidden(new Set(['uniform', 'cosine'])));
  document.addEventListener('change', event => {
    const {tool} = event.target.dataset;
    if (!tool) return;
    state[tool] = event.target.value;
    show_tools();
    redraw(f => f === event.target.closest('figure'));
  });
  document.addEventListener('click', event => {
    const {save: format} = event.target.dataset;
    if (format) save(event.target.closest('figure'), format);
  });
  const follow = () => {
    const found = location.hash.match(/^#material-(\d+)$/);
    if (found && Number(found[1]) < report.materials.length) {
      show_material(Number(found[1]));
      element(`material-${found[1]}`).scrollIntoView();
    }
  };
  addEventListener('hashchange', follow);
  element('overview-table').addEventListener('click', event => {  // the link of the material that is in the address already
    if (event.target.hash === location.hash) follow();
  });
  let timer;
  let width = innerWidth;
  addEventListener('resize', () => {
    if (innerWidth === width) return;
    width = innerWidth;
    clearTimeout(timer);
    timer = setTimeout(redraw, 150);
  });
  dark_theme.addEventListener('change', () => redraw());
  addEventListener('beforeprint', () => {
    state.printing = element('methods-box').open = true;
    report.materials.forEach((_, n) => { element(`material-${n}`).hidden = false; });
    visible_figures().forEach(draw);
  });
  addEventListener('afterprint', () => {
    state.printing = false;
    show_material(state.material);
  });
  show_material(0);
  follow();
}

start();
