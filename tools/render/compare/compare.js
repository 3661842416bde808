// Puts a comparison on its page: tables, curves of convergence, pictures.
const comparison = JSON.parse(document.getElementById('report').textContent);
const element = id => document.getElementById(id);
const escaped = text => String(text).replace(/[&<>"]/g, c => ({'&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;'}[c]));
const dark_theme = matchMedia('(prefers-color-scheme: dark)');
const light_colors = {back: '#ffffff', text: '#1b1f24', dim: '#57606a', line: '#d0d7de'};
const dark_colors = {back: '#14171a', text: '#e6e9ec', dim: '#a0a8b0', line: '#3a4148'};

// The styles that the report gives to the same methods.
const report_keys = {nearest: 'nearest outgoing', mixture: 'mixture outgoing', displacement: 'displacement outgoing', half: 'blend half', rgl: 'rgl half'};
method_styles.default = ['#b2182b', 'circle', []];
const key_of_run = run => report_keys[run.method] || run.method;

const strategies = [
  {id: 'mis', title: 'With multiple importance sampling', text: 'Direct light is drawn from the lights and from the material, and combined.'},
  {id: 'bsdf', title: 'Material sampling alone', text: 'All light is found by directions that the material proposes.'},
];
const runs_of = strategy => comparison.runs.filter(run => run.strategy === strategy.id);

const plus_minus = (x, error) => `${number(x)} ± ${number(error, 2)}`;

function table(strategy) {
  const runs = runs_of(strategy), least = Math.min(...runs.map(run => run.relmse));
  const rows = runs.map(run => {
    const cells = [run.samples, plus_minus(run.relmse, run.standard_error), number(run.ratio), plus_minus(run.relmse_at_equal_samples, run.standard_error_at_equal_samples),
      number(run.ratio_at_equal_samples),
      number(run.microseconds_per_sample), number(run.cost_ratio), number(run.build_seconds, 2)];
    return `<tr${run.relmse === least ? ' class="best"' : ''}><td>${key_mark(key_of_run(run))}${escaped(run.method)}</td>${cells.map(c => `<td>${c}</td>`).join('')}</tr>`;
  });
  const heads = ['method', 'samples', `relMSE after ${number(comparison.seconds)} s`, 'over default’s', `relMSE at ${comparison.equal_samples} samples`, 'over default’s', 'µs a sample', 'cost over default’s', 'build, s'];
  return `<table><thead><tr>${heads.map(h => `<th scope="col">${h}</th>`).join('')}</tr></thead><tbody>${rows.join('')}</tbody></table>`;
}

function convergence_chart(strategy, field, title, width) {
  const c = dark_theme.matches ? dark_colors : light_colors;
  const rows = runs_of(strategy).flatMap(run => run.convergence.filter(p => p.relmse > 0).map(p => ({...style_of(key_of_run(run)), key: key_of_run(run), x: p[field], y: p.relmse,
    tip: {method: run.method, samples: p.samples, 'processor time': `${number(p.seconds)} s`, relMSE: number(p.relmse)}})));
  const xs = log_domain(rows.map(r => r.x), 1.1), ys = log_domain(rows.map(r => r.y));
  return spec_of({width, colors: c}, 320, {
    data: [{name: 'rows', values: rows}],
    scales: [{name: 'x', type: 'log', domain: xs, range: 'width'}, {name: 'y', type: 'log', domain: ys, range: 'height'}],
    axes: [log_axis('bottom', 'x', xs, title), log_axis('left', 'y', ys, 'relMSE')],
    marks: [line_marks('rows')],
  });
}

const views = [];

function draw() {
  for (const view of views.splice(0)) view.finalize();
  for (const figure of document.querySelectorAll('[data-field]')) {
    const box = figure.querySelector('.chart'), strategy = strategies.find(s => s.id === figure.dataset.strategy);
    const title = figure.dataset.field === 'seconds' ? 'processor time, s' : 'samples a pixel';
    const spec = convergence_chart(strategy, figure.dataset.field, title, Math.max(240, Math.floor(box.clientWidth)));
    box.textContent = '';
    const view = new vega.View(vega.parse(spec), {renderer: 'svg', container: box, hover: false});
    view.description(figure.querySelector('h3').textContent).run();
    views.push(view);
  }
}

const picture = (title, source) => `<figure><img src="${escaped(source)}" alt="${escaped(title)}"><figcaption>${escaped(title)}</figcaption></figure>`;

function section(strategy) {
  const chart = (field, title) => `<figure data-field="${field}" data-strategy="${strategy.id}"><h3>${title}</h3><div class="chart"></div></figure>`;
  const keys = runs_of(strategy).map(run => `${key_mark(key_of_run(run))}${escaped(run.method)}`).join(' &nbsp; ');
  return `<section><h2>${strategy.title}</h2><p>${strategy.text}</p><div class="scroll">${table(strategy)}</div><p>${keys}</p>` +
    `<div class="charts">${chart('seconds', 'Error over time')}${chart('samples', 'Error over samples')}</div>` +
    `<h3>Differences from the reference, after ${number(comparison.seconds)} s</h3><div class="pictures">${runs_of(strategy).map(run => picture(run.method, run.difference)).join('')}</div>` +
    `<h3>Pictures</h3><div class="pictures">${picture('reference', comparison.reference.picture)}${runs_of(strategy).map(run => picture(run.method, run.picture)).join('')}</div></section>`;
}

element('scene').textContent = comparison.scene;
element('machine').textContent = `gonio ${comparison.gonio_version}, ${comparison.machine.cpu}, ${comparison.machine.compiler}; ${comparison.width} × ${comparison.height} pixels, ` +
  `${comparison.pixels} of them on the material; reference: ${comparison.reference.samples} samples, its own relMSE ${number(comparison.reference.relmse)}`;
element('strategies').innerHTML = strategies.map(section).join('');
draw();
let timer;
addEventListener('resize', () => {
  clearTimeout(timer);
  timer = setTimeout(draw, 150);
});
dark_theme.addEventListener('change', draw);
