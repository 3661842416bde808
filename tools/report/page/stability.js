// Where methods fail: the rows of `gonio stability`, if the report holds them, as tables.
const stability_rows = () => (report.stability || {}).rows || [];
const unique = values => [...new Set(values)];
const failed_marks = {max_error: 'E', bias: 'B', chi2_p: 'χ²'};
const is_library = variant => variant.startsWith('gonio-');
const marks_of = row => row.failed.map(f => failed_marks[f] || f).join(' ');
const figures_of = row => `error ${number(row.max_error, 2)} of ${number(row.max_error_bound, 3)} ulp, bias ${number(100 * row.bias, 2)} %, χ² p ${number(row.chi2_p, 2)}`;

function stability_html() {
  const rows = stability_rows();
  if (!rows.length) return '';
  const variants = unique(rows.map(r => r.variant)), inputs = unique(rows.map(r => r.input));
  const textbook = variants.filter(v => !is_library(v)), own = variants.filter(is_library);
  const failing = list => list.filter(v => rows.some(r => r.variant === v && r.fails)).length;
  const worst = (list, value) => list.reduce((a, b) => value(b) > value(a) ? b : a);
  const summary = variants.map(variant => {
    const own_rows = rows.filter(r => r.variant === variant), fails = own_rows.filter(r => r.fails).length;
    const error = worst(own_rows, r => r.max_error / r.max_error_bound), bias = worst(own_rows, r => Math.abs(r.bias)), p = worst(own_rows, r => -r.chi2_p);
    const bad = (row, key, text) => row.failed.includes(key) ? `<strong>${text}</strong>` : text;
    return `<tr${is_library(variant) ? ' class="own"' : ''}><th scope="row">${escaped(variant)}</th><td>${fails ? `<strong>${fails}</strong>` : '0'} of ${own_rows.length}</td>` +
      `<td>${bad(error, 'max_error', number(error.max_error, 2))} of ${number(error.max_error_bound, 3)}</td><td>${bad(bias, 'bias', `${number(100 * bias.bias, 2)} %`)}</td>` +
      `<td>${bad(p, 'chi2_p', number(p.chi2_p, 2))}</td><td class="wrap">${escaped(own_rows[0].why)}</td></tr>`;
  });
  const heads = ['variant', 'fails on', 'largest error, ulp', 'largest bias', 'smallest χ² p', 'why'];
  const matrix = inputs.map(input => `<tr><th scope="row">${escaped(input)}</th>` + variants.map(variant => {
    const row = rows.find(r => r.variant === variant && r.input === input);
    if (!row) return '<td></td>';
    const text = row.fails ? marks_of(row) : '·';
    return `<td class="${row.fails ? 'fails' : 'holds'}" title="${escaped(`${variant} on ${input}: ${figures_of(row)}`)}">${text}<span class="hidden">${row.fails ? 'fails' : 'holds'}</span></td>`;
  }).join('') + '</tr>');
  return '<h2>Where methods fail</h2>' +
    `<p>Formulas of the literature beside the library's own (gonio-…), in float, on ${inputs.length} inputs, judged in long double. ` +
    `${failing(textbook)} of ${textbook.length} textbook formulas fail somewhere, ${failing(own) || 'none'} of the library's ${own.length}. The same for every material.</p>` +
    `<div class="scroll" tabindex="0" role="region" aria-label="Variants"><table><caption>Worst of each variant; <strong>bold</strong> where it is a failure</caption>` +
    `<thead><tr>${heads.map(h => `<th scope="col"${h === 'why' ? ' class="left"' : ''}>${h}</th>`).join('')}</tr></thead><tbody>${summary.join('')}</tbody></table></div>` +
    `<div class="scroll" tabindex="0" role="region" aria-label="Variants by inputs"><table class="matrix"><caption>Which variant fails on which input: <b>E</b> by its error, <b>B</b> by bias of an estimate, <b>χ²</b> by draws that do not follow the pdf; · holds</caption>` +
    `<thead><tr><th scope="col">input</th>${variants.map(v => `<th scope="col"><span>${escaped(v)}</span></th>`).join('')}</tr></thead><tbody>${matrix.join('')}</tbody></table></div>` +
    `<p class="row"><label>By how much: <select id="variant">${options_of(variants.map(v => [v, v]))}</select></label></p><div class="scroll" id="variant-rows" tabindex="0" role="region" aria-label="Figures of one variant">${variant_table(variants[0])}</div>`;
}

function variant_table(variant) {
  const rows = stability_rows().filter(r => r.variant === variant);
  const body = rows.map(r => `<tr><th scope="row">${escaped(r.input)}</th><td>${number(r.max_error, 2)}</td><td>${number(r.max_error_bound, 3)}</td><td>${number(100 * r.bias, 2)} %</td>` +
    `<td>${number(100 * r.bias_standard_error, 2)} %</td><td>${number(r.chi2_p, 2)}</td><td class="left">${r.fails ? `<strong>${marks_of(r)}</strong>` : '–'}</td></tr>`);
  const heads = ['input', 'error, ulp', 'bound', 'bias', 'standard error', 'χ² p', 'fails by'];
  return `<table><caption>${escaped(variant)}: ${escaped(rows[0].why)}. Error: ${escaped(rows[0].error_of)}.</caption><thead><tr>${heads.map(h => `<th scope="col"${h === 'fails by' ? ' class="left"' : ''}>${h}</th>`).join('')}</tr></thead><tbody>${body.join('')}</tbody></table>`;
}
