// Poses a page's mesh as the page does, without a browser: rig.mjs SCRIPTS PAGE SHARE..., each a share of the time of its
// animations. Prints, for each animation and time, [name, time, points before, points after, normals before] as JSON.
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import vm from 'node:vm';

const [scripts, file, ...shares] = process.argv.slice(2);
const blocks = {};
for (const [, id, text] of readFileSync(file, 'utf8').matchAll(/<script type="[^"]*" id="([^"]*)">([^<]*)<\/script>/g)) {
  blocks[id] = {textContent: text, remove() {}};
}
const source = ['rig.js', 'morph.js', 'decode.js', 'normals.js'].map((name) => readFileSync(join(scripts, name), 'utf8')).join('\n');
const page = vm.runInNewContext(source + '\n;({readScene, poseScene, splitVertices, poseNormals, jointMarks})',
  {byId: (id) => blocks[id] || null, atob, console});
const scene = page.readScene();
const split = page.splitVertices(scene);
const {center, scale} = scene.space;
const points = (share) => Array.from({length: scene.vertices}, (_, v) =>
  [0, 1, 2].map((a) => (scene.before[3 * v + a] + share * scene.move[3 * v + a]) * scale + center[a]));
const found = [];
for (const animation of scene.rig.animations) {
  for (const share of shares.map(Number)) {
    const time = animation.begin + share * (animation.end - animation.begin);
    const poses = page.poseScene(scene, animation, time);
    const normals = page.poseNormals(split, poses, split.normals);
    const joints = page.jointMarks(scene, animation, time).points;
    found.push([animation.name, time, points(0), points(1),
      Array.from(split.sources, (v, i) => [v, [0, 1, 2].map((a) => normals[8 * i + a] / 32767)]),
      Array.from({length: joints.length / 6}, (_, j) => [0, 1, 2].map((a) => joints[6 * j + a] * scale + center[a]))]);
  }
}
page.poseScene(scene, null, 0);
found.push(['rest', 0, points(0), points(1), [], []]);
console.log(JSON.stringify(found));
