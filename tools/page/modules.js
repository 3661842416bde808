// Debian ships Vega as the modules it is made of: `gonio_modules` is their registry, filled by the
// build, and this puts together what the package "vega" would.
const gonio_loaded = {};
function gonio_require(name) {
  if (!gonio_loaded[name]) {
    gonio_loaded[name] = {};
    const module = {exports: gonio_loaded[name]};
    gonio_modules[name](module, module.exports, gonio_require);
  }
  return gonio_loaded[name];
}
const vega = (() => {
  const transforms = gonio_require('vega-dataflow').transforms;
  for (const name of ['vega-transforms', 'vega-view-transforms', 'vega-encode', 'vega-label'])
    Object.assign(transforms, gonio_require(name));
  return {View: gonio_require('vega-view').View, parse: gonio_require('vega-parser').parse};
})();
