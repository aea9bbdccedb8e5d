// Moves the sliders of a page's morph targets as the page does, without a browser: morph.mjs SCRIPTS PAGE WEIGHTS
// ANIMATION SHARE, with WEIGHTS a JSON object of values by name, and ANIMATION "" for rest. Prints {sliders, before, after,
// normals}: of the file's vertices the places by their numbers; of what is drawn [vertex, normal before, normal after].
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import vm from 'node:vm';

const [scripts, file, weights, animation, share] = process.argv.slice(2);
const blocks = {};
for (const [, id, text] of readFileSync(file, 'utf8').matchAll(/<script type="[^"]*" id="([^"]*)">([^<]*)<\/script>/g)) {
  blocks[id] = {textContent: text, remove() {}};
}
const source = ['rig.js', 'morph.js', 'decode.js', 'normals.js'].map((name) => readFileSync(join(scripts, name), 'utf8')).join('\n');
const page = vm.runInNewContext(source + '\n;({readScene, poseScene, splitVertices, morphNormals, shownWeights, vertexNumber})',
  {byId: (id) => blocks[id] || null, atob, console});
const scene = page.readScene();
const split = page.splitVertices(scene);
for (const [name, value] of Object.entries(JSON.parse(weights))) {
  for (const slider of scene.sliders.filter((one) => one.name === name)) slider.value = value;
}
const {center, scale} = scene.space;
const found = (scene.rig ? scene.rig.animations : []).find(({name}) => name === animation);
const poses = page.poseScene(scene, found || null, found ? found.begin + Number(share) * (found.end - found.begin) : 0);
const points = (part) => Object.fromEntries(Array.from({length: scene.vertices}, (_, v) => [page.vertexNumber(scene, v),
  [0, 1, 2].map((a) => (scene.before[3 * v + a] + part * scene.move[3 * v + a]) * scale + center[a])]));
const normals = page.morphNormals(scene, split);
const shown = page.shownWeights(scene, poses);
console.log(JSON.stringify({
  sliders: scene.sliders.map(({name, weight}, i) => [name, weight, shown[i]]), isMorphed: poses.isMorphed, before: points(0), after: points(1),
  normals: Array.from(split.sources, (v, i) => [v, ...[0, 4].map((at) => [0, 1, 2].map((a) => normals[8 * i + at + a] / 32767))]),
}));
