// The files of the machine for the program in node: emscripten's NODEFS, but for the whole tree, with links, pipes and devices
// as they are, and errors as the system has them.
import fs from 'node:fs';
import {attempt as attemptOf} from './run.mjs';

// musl's numbers, which are those of all emscripten programs.
const CREATE = 0o100, NO_FOLLOW = 0o400000;
const FLAGS = [[0o1, 'O_WRONLY'], [0o2, 'O_RDWR'], [0o2000, 'O_APPEND']];

export function showFiles(FS, ERRNO_CODES) {
  const attempt = (call) => attemptOf(FS, ERRNO_CODES, call);
  const join = (folder, name) => folder === '/' ? '/' + name : folder + '/' + name;
  const pathOf = (node) => node.parent === node ? '/' : join(pathOf(node.parent), node.name);

  function makeNode(parent, name, mode) {
    const node = FS.createNode(parent, name, mode, 0);
    node.node_ops = nodeOperations;
    node.stream_ops = streamOperations;
    return node;
  }

  const nodeOperations = {
    getattr(node) {
      const stat = attempt(() => fs.lstatSync(pathOf(node)));
      // It may have become something else.
      node.mode = stat.mode;
      return stat;
    },
    setattr(node, {mode, size, timestamp}) {
      const path = pathOf(node);
      attempt(() => {
        if (mode !== undefined) fs.chmodSync(path, mode & 0o7777);
        if (size !== undefined) fs.truncateSync(path, size);
        if (timestamp !== undefined) fs.utimesSync(path, timestamp / 1000, timestamp / 1000);
      });
    },
    lookup(parent, name) {
      return makeNode(parent, name, attempt(() => fs.lstatSync(join(pathOf(parent), name))).mode);
    },
    mknod(parent, name, mode) {
      const path = join(pathOf(parent), name);
      attempt(() => FS.isDir(mode) ? fs.mkdirSync(path, mode & 0o7777) : fs.closeSync(fs.openSync(path, 'wx', mode & 0o7777)));
      return makeNode(parent, name, mode);
    },
    rename(node, folder, name) {
      attempt(() => fs.renameSync(pathOf(node), join(pathOf(folder), name)));
      node.parent = folder;
      node.name = name;
    },
    unlink(parent, name) {
      attempt(() => fs.unlinkSync(join(pathOf(parent), name)));
    },
    rmdir(parent, name) {
      attempt(() => fs.rmdirSync(join(pathOf(parent), name)));
    },
    readdir(node) {
      return ['.', '..', ...attempt(() => fs.readdirSync(pathOf(node)))];
    },
    symlink(parent, name, target) {
      attempt(() => fs.symlinkSync(target, join(pathOf(parent), name)));
      return makeNode(parent, name, 0o120777);
    },
    readlink(node) {
      return attempt(() => fs.readlinkSync(pathOf(node)));
    },
  };

  const streamOperations = {
    open(stream) {
      if (FS.isDir(stream.node.mode)) return;
      const flags = FLAGS.reduce((sum, [bit, name]) => stream.flags & bit ? sum | fs.constants[name] : sum, 0);
      // A pipe without a writer must not block here.
      stream.file = attempt(() => fs.openSync(pathOf(stream.node), flags | (fs.constants.O_NONBLOCK ?? 0)));
      stream.seekable = FS.isFile(stream.node.mode);
    },
    close(stream) {
      if (stream.file !== undefined) attempt(() => fs.closeSync(stream.file));
    },
    read(stream, heap, offset, length, position) {
      return attempt(() => fs.readSync(stream.file, heap, offset, length, stream.seekable ? position : null));
    },
    write(stream, heap, offset, length, position) {
      return attempt(() => fs.writeSync(stream.file, heap, offset, length, stream.seekable ? position : null));
    },
    llseek(stream, offset, whence) {
      const from = [0, stream.position, whence === 2 ? attempt(() => fs.fstatSync(stream.file)).size : 0][whence];
      if (from + offset < 0) throw new FS.ErrnoError(ERRNO_CODES.EINVAL);
      return from + offset;
    },
  };

  // The tree of the machine in place of the one in memory, with that one's devices.
  const devices = FS.lookupPath('/dev').node;
  const mount = {type: {}, opts: {}, mountpoint: '/', mounts: []};
  const root = FS.createNode(null, '/', fs.lstatSync('/').mode, 0);
  root.node_ops = nodeOperations;
  root.stream_ops = streamOperations;
  root.mount = mount;
  mount.root = root;
  FS.root = root;
  const place = FS.lookupPath('/dev').node;
  place.mounted = {root: devices, mountpoint: '/dev', mounts: []};
  FS.chdir(process.cwd());

  // Tells why a file cannot be opened; emscripten says of all that there is none.
  const open = FS.open;
  FS.open = (path, flags, ...others) => {
    if (typeof flags === 'number' && !(flags & CREATE)) FS.lookupPath(path, {follow: !(flags & NO_FOLLOW)});
    return open(path, flags, ...others);
  };
}

const nap = new Int32Array(new SharedArrayBuffer(4));

// Calls again what a stream that does not block cannot do yet.
function patiently(call) {
  for (;;) {
    try {
      return call();
    } catch (problem) {
      if (problem.code === 'EOF') return 0;
      if (problem.code !== 'EAGAIN') throw problem;
      Atomics.wait(nap, 0, 0, 10);
    }
  }
}

// The streams of this process.
export const streams = {
  input: (bytes) => patiently(() => fs.readSync(0, bytes, 0, bytes.length, null)),
  output: (bytes) => patiently(() => fs.writeSync(1, bytes, 0, bytes.length, null)),
  failure: (bytes) => patiently(() => fs.writeSync(2, bytes, 0, bytes.length, null)),
};
