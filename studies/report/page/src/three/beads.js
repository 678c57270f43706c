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

const FRAGMENT = `
precision highp float;
in vec2 corner; in float shade; in float tall;
uniform sampler2D colours; uniform float depthPerMetre;
out vec4 colour;
void main() {
  float away = dot(corner, corner);
  if (away > 1.0) discard;
  vec3 normal = vec3(corner, sqrt(1.0 - away));
  float light = 0.42 + 0.58 * max(0.0, dot(normal, normalize(vec3(-0.35, 0.55, 0.76))));
  float edge = smoothstep(0.0, 0.35, normal.z);
  colour = vec4(texture(colours, vec2(shade * 0.996 + 0.002, 0.5)).rgb * light * mix(0.6, 1.0, edge), 1.0);
  gl_FragDepth = gl_FragCoord.z - normal.z * tall * depthPerMetre;
}`;

function ramp() {
  const bytes = new Uint8Array(256 * 4);
  for (let index = 0; index < 256; index++) bytes.set([...channels("viridis", index / 255), 255], 4 * index);
  const texture = new DataTexture(bytes, 256, 1, RGBAFormat, UnsignedByteType);
  texture.needsUpdate = true;
  return texture;
}

/** movie: {beads, low, span: Vector3, radius: Float32Array, position: Uint16Array, speed: Uint8Array} of all frames. */
export class Beads {
  constructor(movie) {
    this.movie = movie;
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    geometry.instanceCount = movie.beads;
    this.place = new InstancedBufferAttribute(new Uint16Array(3 * movie.beads), 3, true);
    this.fast = new InstancedBufferAttribute(new Uint8Array(movie.beads), 1, true);
    geometry.setAttribute("place", this.place);
    geometry.setAttribute("fast", this.fast);
    geometry.setAttribute("size", new InstancedBufferAttribute(movie.radius, 1));
    geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
    const material = new ShaderMaterial({ glslVersion: GLSL3, vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms: {
      low: { value: movie.low }, span: { value: movie.span }, cut: { value: Infinity }, colours: { value: ramp() }, depthPerMetre: { value: 1 } } });
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
  }

  show(frame) {
    const { beads, position, speed } = this.movie;
    this.place.array.set(position.subarray(3 * beads * frame, 3 * beads * (frame + 1)));
    this.fast.array.set(speed.subarray(beads * frame, beads * (frame + 1)));
    this.place.needsUpdate = true;
    this.fast.needsUpdate = true;
  }

  /** Beads whose centres lie nearer to the viewer of the end than `z` are left out. */
  cutAt(z) {
    this.mesh.material.uniforms.cut.value = z;
  }

  /** An orthographic camera's depth buffer is even: the same for each metre. */
  prepare(camera) {
    this.mesh.material.uniforms.depthPerMetre.value = 1 / (camera.far - camera.near);
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.mesh.material.uniforms.colours.value.dispose();
    this.mesh.material.dispose();
  }
}
