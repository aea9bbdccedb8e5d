// A function for documents of gltf-transform: await document.transform(ffd({lattice}))
import {WebIO} from '@gltf-transform/core';
import {init} from './ffd-mesh.mjs';
import {refuse} from './error.mjs';

// What these add or change is more than the attributes of meshes.
const REFUSED = ['asMorph', 'clip', 'morph', 'output', 'rig'];
const NAME = 'document.gltf';

let shared;

// The document's own objects stay: what is deformed is set in them. lattice, and the other options of `deform`.
export function ffd({lattice, ffd: instance, ...options}) {
  for (const name of REFUSED) if (options[name] !== undefined) refuse(`gltf-transform: the option ${name} is for ffd.deform`);
  return async function ffd(document) {
    const used = instance ?? await (shared ??= init());
    const io = new WebIO().registerExtensions(document.getRoot().listExtensionsUsed().map((extension) => extension.constructor));
    const {json, resources} = await io.writeJSON(document);
    const {bytes, files, warnings} = await used.deform(
      {name: NAME, bytes: JSON.stringify(json), files: resources}, lattice, options);
    warnings.forEach((line) => document.getLogger().warn(line));
    const deformed = await io.readJSON({json: JSON.parse(new TextDecoder().decode(bytes)), resources: {...resources, ...files}});
    copy(deformed.getRoot(), document.getRoot());
  };
}

// Gives `to` the attributes of `from`, which has the same nodes. Nodes that shared a mesh, and meshes that shared an accessor, get
// their own where they differ now.
function copy(from, to) {
  const accessors = new Sharing((accessor, source) => {
    if (!equal(accessor, source))
      accessor.setArray(source.getArray()).setType(source.getType()).setNormalized(source.getNormalized()).setSparse(source.getSparse());
  }, (accessor) => accessor.clone());
  const fill = (owner, source) => owner.listSemantics().forEach((semantic) =>
    owner.setAttribute(semantic, accessors.of(owner.getAttribute(semantic), source.getAttribute(semantic))));
  const meshes = new Sharing((mesh, source) => mesh.listPrimitives().forEach((primitive, i) => {
    const other = source.listPrimitives()[i];
    fill(primitive, other);
    primitive.listTargets().forEach((target, k) => fill(target, other.listTargets()[k]));
  }), cloneMesh);
  to.listNodes().forEach((node, i) => {
    if (node.getMesh()) node.setMesh(meshes.of(node.getMesh(), from.listNodes()[i].getMesh()));
  });
  // Those that no node shows.
  to.listMeshes().forEach((mesh, i) => { if (!meshes.has(mesh)) meshes.of(mesh, from.listMeshes()[i]); });
}

function equal(a, b) {
  const x = a.getArray(), y = b.getArray();
  return a.getType() === b.getType() && x.constructor === y.constructor && x.length === y.length && x.every((n, i) => Object.is(n, y[i]));
}

// A mesh of which nothing that is filled is shared.
function cloneMesh(mesh) {
  const copied = mesh.clone();
  mesh.listPrimitives().forEach((primitive) => {
    const own = primitive.clone();
    primitive.listTargets().forEach((target) => own.removeTarget(target).addTarget(target.clone()));
    copied.removePrimitive(primitive).addPrimitive(own);
  });
  return copied;
}

// The first source of an object fills it, each further one a copy.
class Sharing {
  #made = new Map();
  constructor(fill, clone) {
    this.fill = fill;
    this.clone = clone;
  }
  has(object) {
    return this.#made.has(object);
  }
  of(object, source) {
    const made = this.#made.get(object) ?? new Map();
    this.#made.set(object, made);
    if (!made.has(source)) {
      const own = made.size === 0 ? object : this.clone(object);
      made.set(source, own);
      this.#made.set(own, made);
      this.fill(own, source);
    }
    return made.get(source);
  }
}
