// Beads as spheres without triangles: each is a square that faces the camera, on which the shader draws a lit sphere with its true depth.
// A million corners less than meshes of spheres, so that a whole mill turns on an office computer.
import { BufferAttribute, DataTexture, GLSL3, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, RGBAFormat, ShaderMaterial, Sphere,
  UnsignedByteType, Vector3 } from "three";
import { channels } from "../colours.js";

const VERTEX = `
in vec3 place; in float size; in float fast;
uniform vec3 low, span; uniform float cut;
out vec2 corner; out float shade; out float tall;
void main() {
  vec3 centre = low + place * span;
  vec4 seen = modelViewMatrix * vec4(centre, 1.0);
  corner = position.xy; shade = fast; tall = size;
  seen.xy += position.xy * size;
  gl_Position = projectionMatrix * seen;
  if (centre.z > cut) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;

export const MANY = 15000; // beads; more of them are drawn flat, front to back, so that what is covered costs nothing
const SIDES = 10; // of a bead that is drawn flat
const LAYERS = 512; // of equal depth, into which many beads are sorted

const fragment = (flat) => `
precision highp float;
in vec2 corner; in float shade; in float tall;
uniform sampler2D colours; uniform float depthPerMetre;
out vec4 colour;
void main() {
  float away = dot(corner, corner);
  ${flat ? "" : "if (away > 1.0) discard;"}
  vec3 normal = vec3(corner, sqrt(max(0.0, 1.0 - away)));
  float light = 0.42 + 0.58 * max(0.0, dot(normal, normalize(vec3(-0.35, 0.55, 0.76))));
  float edge = smoothstep(0.0, 0.35, normal.z);
  colour = vec4(texture(colours, vec2(shade * 0.996 + 0.002, 0.5)).rgb * light * mix(0.6, 1.0, edge), 1.0);
  ${flat ? "" : "gl_FragDepth = gl_FragCoord.z - normal.z * tall * depthPerMetre;"}
}`;

/** A square round the circle of radius 1, or a polygon as large as the circle, which needs no holes. */
function outline(sides) {
  const reach = sides === 4 ? Math.SQRT2 : Math.sqrt((2 * Math.PI) / sides / Math.sin((2 * Math.PI) / sides));
  const angles = [...Array(sides).keys()].map((side) => ((side + 0.5) * 2 * Math.PI) / sides);
  return new Float32Array(angles.flatMap((angle) => [reach * Math.cos(angle), reach * Math.sin(angle), 0]));
}

function ramp() {
  const bytes = new Uint8Array(256 * 4);
  for (let index = 0; index < 256; index++) bytes.set([...channels("sequential", index / 255), 255], 4 * index);
  const texture = new DataTexture(bytes, 256, 1, RGBAFormat, UnsignedByteType);
  texture.needsUpdate = true;
  return texture;
}

/** movie: {beads, low, span: Vector3, radius: Float32Array, position: Uint16Array, speed: Uint8Array} of all frames. */
export class Beads {
  constructor(movie) {
    this.movie = movie;
    this.many = movie.beads > MANY;
    this.order = new Uint32Array(movie.beads);
    this.layer = new Uint16Array(movie.beads);
    this.eye = new Vector3(0, 0, 1);
    const geometry = new InstancedBufferGeometry();
    const corners = outline(this.many ? SIDES : 4);
    geometry.setAttribute("position", new BufferAttribute(corners, 3));
    geometry.setIndex([...Array(corners.length / 3 - 2).keys()].flatMap((corner) => [0, corner + 1, corner + 2]));
    geometry.instanceCount = movie.beads;
    this.place = new InstancedBufferAttribute(new Uint16Array(3 * movie.beads), 3, true);
    this.fast = new InstancedBufferAttribute(new Uint8Array(movie.beads), 1, true);
    geometry.setAttribute("place", this.place);
    geometry.setAttribute("fast", this.fast);
    this.size = new InstancedBufferAttribute(new Float32Array(movie.radius), 1);
    geometry.setAttribute("size", this.size);
    geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
    const material = new ShaderMaterial({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: fragment(this.many), uniforms: {
      low: { value: movie.low }, span: { value: movie.span }, cut: { value: Infinity }, colours: { value: ramp() }, depthPerMetre: { value: 1 } } });
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
  }

  show(frame) {
    this.frame = frame;
    const { beads, position, speed } = this.movie;
    const at = beads * frame;
    if (this.many) this.showSorted(position.subarray(3 * at, 3 * (at + beads)), speed.subarray(at, at + beads));
    else {
      this.place.array.set(position.subarray(3 * at, 3 * (at + beads)));
      this.fast.array.set(speed.subarray(at, at + beads));
    }
    this.place.needsUpdate = true;
    this.fast.needsUpdate = true;
  }

  /** The nearest first, by counting into layers of depth. */
  showSorted(position, speed) {
    const { beads, span, radius } = this.movie;
    const weight = [span.x * this.eye.x, span.y * this.eye.y, span.z * this.eye.z].map((one) => one / 65535);
    let [least, most] = [0, 0];
    for (const one of weight) {
      if (one > 0) most += one * 65535;
      else least += one * 65535;
    }
    const perMetre = (LAYERS - 1) / Math.max(1e-12, most - least);
    const starts = new Uint32Array(LAYERS + 1);
    for (let bead = 0; bead < beads; bead++) {
      const depth = weight[0] * position[3 * bead] + weight[1] * position[3 * bead + 1] + weight[2] * position[3 * bead + 2];
      this.layer[bead] = (most - depth) * perMetre;
      starts[this.layer[bead] + 1] += 1;
    }
    for (let layer = 0; layer < LAYERS; layer++) starts[layer + 1] += starts[layer];
    for (let bead = 0; bead < beads; bead++) this.order[starts[this.layer[bead]]++] = bead;
    for (let to = 0; to < beads; to++) {
      const bead = this.order[to];
      for (let part = 0; part < 3; part++) this.place.array[3 * to + part] = position[3 * bead + part];
      this.fast.array[to] = speed[bead];
      this.size.array[to] = radius[bead];
    }
    this.size.needsUpdate = true;
  }

  /** Beads whose centres lie nearer to the viewer of the end than `z` are left out. */
  cutAt(z) {
    this.mesh.material.uniforms.cut.value = z;
  }

  /** An orthographic camera's depth buffer is even: the same for each metre. */
  prepare(camera) {
    if (this.many && this.frame !== undefined) {
      const eye = camera.getWorldDirection(new Vector3()).negate();
      if (eye.distanceToSquared(this.eye) > 1e-3) {
        this.eye.copy(eye);
        this.show(this.frame);
      }
    }
    this.mesh.material.uniforms.depthPerMetre.value = 1 / (camera.far - camera.near);
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.mesh.material.uniforms.colours.value.dispose();
    this.mesh.material.dispose();
  }
}
