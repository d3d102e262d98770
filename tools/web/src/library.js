// What the folder holds: the table of reactions, and the scripts of clips and characters, loaded when they are needed.
// A browser that opened the page from disk fetches nothing; but it runs scripts, and each hands over its data.

const waiting = new Map(); // "kind/key" -> {resolve, reject}
const loaded = new Map(); // "kind/key" -> Promise

let tell = null;
export const table = new Promise((resolve) => {
  tell = resolve;
});

export function register(kind, key, data) {
  if (kind === 'reactions') tell(data);
  else waiting.get(`${kind}/${key}`)?.resolve(data);
}

function load(kind, folder, key) {
  const id = `${kind}/${key}`;
  if (loaded.has(id)) return loaded.get(id);
  const promise = new Promise((resolve, reject) => {
    waiting.set(id, { resolve, reject });
    const script = document.createElement('script');
    script.src = `review/${folder}/${encodeURIComponent(key)}.js`;
    const failed = () => reject(new Error(`review/${folder}/${key}.js cannot be read`));
    script.onerror = failed;
    script.onload = () => {
      script.remove();
      failed(); // of no effect once the script has registered its data
    };
    document.head.append(script);
  }).finally(() => waiting.delete(id));
  loaded.set(id, promise);
  promise.catch(() => loaded.delete(id));
  return promise;
}

export const loadClip = (key) => load('clip', 'clips', key);
export const loadCharacter = (key) => load('character', 'characters', key);

function bytes(text) {
  const binary = atob(text);
  const array = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) array[i] = binary.charCodeAt(i);
  return array.buffer;
}
export const floats = (text) => new Float32Array(bytes(text));
export const words = (text) => new Uint16Array(bytes(text));
export const indices = (text) => new Uint32Array(bytes(text));
/// Numbers stored as whole multiples of a scale.
export const scaled = ({ scale, values }) => Float32Array.from(new Int16Array(bytes(values)), (v) => v * scale);
