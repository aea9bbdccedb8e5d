// WebAssembly modules. The classic script has a function of the same name that takes them from itself.

// Reads a file of this folder, which a page fetches.
export async function loadFile(name) {
  // Tools that bundle scripts find files by this form.
  const url = name === 'core.wasm' ? new URL('core.wasm', import.meta.url) : new URL('program.wasm', import.meta.url);
  return readUrl(url);
}

export async function readUrl(url) {
  if (url.protocol === 'file:' && globalThis.process?.versions?.node) {
    const {readFile} = await import(/* webpackIgnore: true */ /* @vite-ignore */ 'node:fs/promises');
    return readFile(url);
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}
