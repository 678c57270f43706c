// A function of two numbers as a surface that can be turned, in a box whose edges carry the axes' names and ends.
import { AmbientLight, BufferAttribute, BufferGeometry, DirectionalLight, DoubleSide, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial, SRGBColorSpace, Color,
  Vector3 } from "three";
import { channels, theme } from "../colours.js";
import { element } from "../dom.js";
import { number } from "../numbers.js";
import { View } from "./view.js";

const BOX = [[-1, 1], [-0.7, 0.7], [-1, 1]]; // the scene's x, height and depth

const place = (share, axis) => BOX[axis][0] + share * (BOX[axis][1] - BOX[axis][0]);
const shareOf = (value, low, high) => (high > low ? (value - low) / (high - low) : 0.5);

function sheet({ xs, ys, values }, low, high) {
  const count = values.length;
  const [positions, colours, triangles] = [new Float32Array(3 * count), new Float32Array(3 * count), []];
  const colour = new Color();
  for (let index = 0; index < count; index++) {
    const [column, row] = [index % xs.length, Math.floor(index / xs.length)];
    const share = shareOf(values[index], low, high);
    positions.set([place(column / (xs.length - 1), 0), place(share, 1), -place(row / (ys.length - 1), 2)], 3 * index);
    const [red, green, blue] = channels("sequential", share);
    colour.setRGB(red / 255, green / 255, blue / 255, SRGBColorSpace);
    colours.set([colour.r, colour.g, colour.b], 3 * index);
    if (column + 1 < xs.length && row + 1 < ys.length) {
      const across = index + xs.length;
      triangles.push(index, index + 1, across + 1, index, across + 1, across);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("color", new BufferAttribute(colours, 3));
  geometry.setIndex(triangles);
  geometry.computeVertexNormals();
  return new Mesh(geometry, new MeshLambertMaterial({ vertexColors: true, side: DoubleSide }));
}

/** Every few lines of the grid, so that the bend is seen. */
function gridLines(mesh, across, along) {
  const from = mesh.geometry.getAttribute("position");
  const points = [];
  const add = (a, b) => points.push(from.getX(a), from.getY(a) + 0.003, from.getZ(a), from.getX(b), from.getY(b) + 0.003, from.getZ(b));
  const step = 5;
  for (let row = 0; row < along; row++)
    for (let column = 0; column < across; column++) {
      const index = row * across + column;
      if (row % step === 0 && column + 1 < across) add(index, index + 1);
      if (column % step === 0 && row + 1 < along) add(index, index + across);
    }
  return lines(points, 0x1c2329, 0.35);
}

function lines(points, color, opacity = 1) {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
  return new LineSegments(geometry, new LineBasicMaterial({ color, transparent: opacity < 1, opacity }));
}

function box() {
  const [[l, r], [b, t], [n, f]] = BOX;
  return [l, b, n, r, b, n, r, b, n, r, b, f, r, b, f, l, b, f, l, b, f, l, b, n, l, b, -f, l, t, -f, r, b, -f, r, t, -f, l, t, -f, r, t, -f];
}

export class Surface {
  constructor(name) {
    this.view = new View(`${name}. Drag or use the arrow keys to turn it.`, { azimuth: 0.6, height: 0.5 });
    this.works = Boolean(this.view.renderer);
    if (!this.works) return;
    this.view.scene.add(new AmbientLight(0xffffff, 2.2));
    const sun = new DirectionalLight(0xffffff, 1.4);
    sun.position.set(0.3, 1, 0.5);
    this.view.scene.add(sun);
    this.labels = [];
    this.view.before.push((camera, width, height) => this.placeLabels(camera, width, height));
    this.view.fit(new Vector3(0, 0, 0), 1.62, 1.5);
    this.element = this.view.element;
  }

  /** x, y: {name, min, max}; field: {xs, ys, values, name}. */
  show({ x, y, field }) {
    for (const old of this.content ?? []) {
      this.view.scene.remove(old);
      old.geometry.dispose();
      old.material.dispose();
    }
    for (const label of this.labels) label.node.remove();
    const [low, high] = [Math.min(...field.values), Math.max(...field.values)];
    const mesh = sheet(field, low, high);
    this.content = [mesh, gridLines(mesh, field.xs.length, field.ys.length), lines(box(), theme().faint)];
    this.view.scene.add(...this.content);
    const [[left, right], [bottom, top], [, front]] = BOX;
    this.labels = [[`${x.name}`, 0, bottom - 0.16, front + 0.14], [number(x.min, 3), left, bottom - 0.06, front + 0.14], [number(x.max, 3), right, bottom - 0.06, front + 0.14],
      [`${y.name}`, right + 0.2, bottom - 0.16, 0], [number(y.min, 3), right + 0.14, bottom - 0.02, front - 0.1], [number(y.max, 3), right + 0.14, bottom - 0.06, -front],
      [field.name, right, top + 0.14, -front], [number(high, 3), right + 0.16, top, -front], [number(low, 3), right + 0.16, bottom + 0.1, -front]].map(([text, ...at]) => {
      const node = element("span", { class: "label" }, text);
      this.element.append(node);
      return { node, at: new Vector3(...at) };
    });
    this.view.draw();
  }

  placeLabels(camera, width, height) {
    for (const { node, at } of this.labels) {
      const seen = at.clone().project(camera);
      const margin = node.offsetWidth / 2 + 2;
      const [left, top] = [Math.min(width - margin, Math.max(margin, ((seen.x + 1) / 2) * width)), Math.min(height - 10, Math.max(10, ((1 - seen.y) / 2) * height))];
      node.style.left = `${(100 * left) / width}%`; // shares, because on paper the picture is smaller
      node.style.top = `${(100 * top) / height}%`;
    }
  }
}
