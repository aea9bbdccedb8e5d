// Pages of models beside three.js, with one camera and the page's lights: looks.mjs NODE-FOLDER BROWSER FOLDER FILE...
// For each FOLDER/FILE with its page FOLDER/FILE.html prints [file, difference of the blocks' colours, agreement of the silhouettes].
// FFD_SCREENSHOTS names a folder for both as pictures, FILE.page.png and FILE.three.png, / as -.
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {folder, launch} from './browser.mjs';

const [nodeFolder] = process.argv.slice(2);
const files = process.argv.slice(5);
const SIZE = {width: 640, height: 480}, BLOCK = 8, HOST = 'http://looks.test/';

// Notes the matrices with which a page draws its surface.
function noteMatrices() {
  const names = new WeakMap(), gl = WebGL2RenderingContext.prototype;
  const locate = gl.getUniformLocation, set = gl.uniformMatrix4fv;
  gl.getUniformLocation = function (program, name) {
    const place = locate.call(this, program, name);
    if (place) names.set(place, name);
    return place;
  };
  gl.uniformMatrix4fv = function (place, ...rest) {
    (window.matrices = window.matrices || {})[names.get(place)] = Array.from(rest[1]);
    return set.call(this, place, ...rest);
  };
}

// Draws a model with three.js, in a page of its own. Lights as in src/view/page/shaders.js, fixed to the camera.
async function drawByThree({url, matrices, space, size}) {
  const THREE = await import('three');
  const {GLTFLoader} = await import('three/addons/loaders/GLTFLoader.js');
  const renderer = new THREE.WebGLRenderer({antialias: false, alpha: true, preserveDrawingBuffer: true});
  renderer.setSize(size.width, size.height, false);
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera();
  camera.matrixAutoUpdate = false;
  camera.projectionMatrix.fromArray(matrices.projection);
  camera.projectionMatrixInverse.copy(camera.projectionMatrix).invert();
  camera.matrixWorldAutoUpdate = false;
  camera.matrixWorldInverse.fromArray(matrices.camera);
  camera.matrixWorld.copy(camera.matrixWorldInverse).invert();
  const {scene: model} = await new GLTFLoader().loadAsync(url);
  const lambert = (of, geometry) => new (of.isMeshBasicMaterial ? THREE.MeshBasicMaterial : THREE.MeshLambertMaterial)({color: of.color, map: of.map,
    alphaTest: of.alphaTest, transparent: of.transparent, opacity: of.opacity, side: THREE.DoubleSide, vertexColors: Boolean(geometry.attributes.color),
    ...(of.emissive ? {emissive: of.emissive, emissiveMap: of.emissiveMap, emissiveIntensity: of.emissiveIntensity} : {})});
  model.traverse((node) => {
    if (!node.isMesh) return;
    if (node.isSkinnedMesh) node.frustumCulled = false;
    node.material = lambert(node.material, node.geometry);
  });
  const whole = new THREE.Group(), centred = new THREE.Group();
  whole.scale.setScalar(1 / space.scale);
  centred.position.set(...space.center.map((x) => -x));
  centred.add(model);
  whole.add(centred);
  scene.add(whole);
  const turn = new THREE.Matrix4().extractRotation(camera.matrixWorld);
  const towards = (x, y, z) => new THREE.Vector3(x, y, z).applyMatrix4(turn);
  for (const [share, direction] of [[0.72, [-0.45, 0.65, 0.75]], [0.2, [0.8, 0.1, 0.45]]]) {
    const light = new THREE.DirectionalLight(0xffffff, Math.PI * share);
    light.position.copy(towards(...direction));
    scene.add(light);
  }
  const sky = new THREE.HemisphereLight(new THREE.Color(0.34, 0.34, 0.34), new THREE.Color(0.2, 0.2, 0.2), Math.PI);
  sky.position.copy(towards(0, 1, 0));
  scene.add(sky);
  renderer.render(scene, camera);
  document.body.replaceChildren(renderer.domElement);
  const gl = renderer.getContext(), bytes = new Uint8Array(4 * size.width * size.height);
  gl.readPixels(0, 0, size.width, size.height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  return window.base64(bytes);
}

// Bytes as text: as a list of numbers they take seconds.
function addBase64() {
  window.base64 = (bytes) => {
    let text = '';
    for (let at = 0; at < bytes.length; at += 4096) text += String.fromCharCode(...bytes.subarray(at, at + 4096));
    return btoa(text);
  };
}

// Of the canvas, once it is drawn again, rows from below as three.js has them.
async function pixelsOfPage() {
  document.getElementById('view').dispatchEvent(new WheelEvent('wheel', {deltaY: 0, cancelable: true}));
  await new Promise((done) => requestAnimationFrame(done));
  const gl = document.getElementById('view').getContext('webgl2');
  const {width, height} = gl.canvas, bytes = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  return window.base64(bytes);
}

function compare(a, b, {width, height}) {
  let both = 0, either = 0, sum = 0, count = 0;
  for (let by = 0; by < height; by += BLOCK) {
    for (let bx = 0; bx < width; bx += BLOCK) {
      const means = [[0, 0, 0], [0, 0, 0]];
      let inside = 0;
      for (let y = by; y < Math.min(by + BLOCK, height); y++) {
        for (let x = bx; x < Math.min(bx + BLOCK, width); x++) {
          const at = 4 * (width * y + x), hasA = a[at + 3] > 127, hasB = b[at + 3] > 127;
          both += hasA && hasB;
          either += hasA || hasB;
          if (!hasA || !hasB) continue;
          inside++;
          for (let c = 0; c < 3; c++) {
            means[0][c] += a[at + c];
            means[1][c] += b[at + c];
          }
        }
      }
      if (inside < BLOCK * BLOCK) continue;
      count++;
      sum += [0, 1, 2].reduce((all, c) => all + Math.abs(means[0][c] - means[1][c]) / inside / 255 / 3, 0);
    }
  }
  return [sum / count, both / either];
}

const browser = await launch(['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--webgl-antialiasing-mode=none']);
const three = await browser.newContext({viewport: SIZE});
await three.route(HOST + '**', (route) => {
  const path = new URL(route.request().url()).pathname;
  if (path === '/') {
    const imports = {three: HOST + 'three/build/three.module.js', 'three/addons/': HOST + 'three/examples/jsm/'};
    return route.fulfill({contentType: 'text/html', body: `<script type="importmap">${JSON.stringify({imports})}</script><body></body>`});
  }
  const isModel = path.startsWith('/model/');
  const file = isModel ? join(folder, path.slice('/model/'.length)) : join(nodeFolder, 'node_modules', path);
  return route.fulfill({contentType: isModel ? 'application/octet-stream' : 'text/javascript', body: readFileSync(decodeURIComponent(file))});
});
const other = await three.newPage();
await other.addInitScript(addBase64);
for (const file of files) {
  const page = await browser.newPage({viewport: {width: SIZE.width + 350, height: 900}, reducedMotion: 'reduce'});
  await page.addInitScript(noteMatrices);
  await page.addInitScript(addBase64);
  await page.goto('file://' + encodeURI(join(folder, file + '.html')));
  await page.waitForSelector('html[data-ready]');
  await page.waitForFunction(() => window.matrices);
  await page.waitForTimeout(700);
  const size = await page.evaluate(() => ({width: document.getElementById('view').width, height: document.getElementById('view').height}));
  const mine = await page.evaluate(pixelsOfPage), matrices = await page.evaluate(() => window.matrices);
  const data = JSON.parse(await page.evaluate(() => document.getElementById('scene').textContent));
  const low = data.low, high = data.low.map((x, a) => x + 65535 * data.step[a]);
  const whole = {center: low.map((x, a) => (x + high[a]) / 2), scale: Math.max(...low.map((x, a) => (high[a] - x) / 2)) || 1};
  await other.goto(HOST);
  const theirs = await other.evaluate(drawByThree, {url: HOST + 'model/' + encodeURI(file), matrices, space: whole, size});
  if (process.env.FFD_SCREENSHOTS) {
    const shot = join(process.env.FFD_SCREENSHOTS, file.replaceAll('/', '-'));
    await page.locator('#view').screenshot({path: shot + '.page.png'});
    await other.locator('canvas').screenshot({path: shot + '.three.png'});
  }
  console.log(JSON.stringify([file, ...compare(Buffer.from(mine, 'base64'), Buffer.from(theirs, 'base64'), size)]));
  await page.close();
}
await browser.close();
