// Pictures as numbers: whether they show anything, and how far two differ.
import { PNG } from "pngjs";

export const decode = (bytes) => PNG.sync.read(bytes);

/** Share of the pixels that are unlike the one in the corner. */
export function painted({ data }) {
  let unlike = 0;
  for (let at = 0; at < data.length; at += 4)
    if (Math.abs(data[at] - data[0]) + Math.abs(data[at + 1] - data[1]) + Math.abs(data[at + 2] - data[2]) > 24) unlike += 1;
  return unlike / (data.length / 4);
}

/** How many clearly different colours: a flat area is no picture. */
export function colours({ data }) {
  const found = new Set();
  for (let at = 0; at < data.length; at += 4) found.add(((data[at] >> 4) << 8) | ((data[at + 1] >> 4) << 4) | (data[at + 2] >> 4));
  return found.size;
}

/** Mean difference of the channels, 0 … 1; 1 where the sizes differ. */
export function difference(one, other) {
  if (one.width !== other.width || one.height !== other.height) return 1;
  let sum = 0;
  for (let at = 0; at < one.data.length; at += 4)
    for (let channel = 0; channel < 3; channel++) sum += Math.abs(one.data[at + channel] - other.data[at + channel]);
  return sum / (0.75 * one.data.length * 255);
}
