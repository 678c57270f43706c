// The mill's bodies: half transparent, with their edges drawn, because a shell seen along its axis shows no surface.
import { BufferAttribute, BufferGeometry, DoubleSide, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshLambertMaterial,
  Plane, Vector3 } from "three";
import { inflate } from "../data.js";

const EDGE_ANGLE = 18; // degrees: what bends by less is the facet of a round surface
const MOST_FOR_EDGES = 150000; // triangles; finding the edges of more would hold up the page

export class Liner {
  constructor() {
    this.group = new Group();
    this.turning = new Group();
    this.resting = new Group();
    this.group.add(this.turning, this.resting);
    this.plane = new Plane(new Vector3(0, 0, -1), Infinity); // keeps what lies below z
  }

  async load(liner, colour) {
    for (const body of liner.bodies) {
      const vertices = await inflate(body.vertices_m, "f32", undefined, `body ${body.name}`);
      const triangles = await inflate(body.triangles, "u32", undefined, `body ${body.name}`);
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(vertices, 3));
      geometry.setIndex(new BufferAttribute(triangles, 1));
      geometry.computeVertexNormals();
      const clippingPlanes = [this.plane];
      const surface = new MeshLambertMaterial({ color: 0x8fa3b5, transparent: true, opacity: 0.22, side: DoubleSide, depthWrite: false, clippingPlanes });
      const group = body.turns ? this.turning : this.resting;
      group.add(new Mesh(geometry, surface));
      if (triangles.length / 3 <= MOST_FOR_EDGES)
        group.add(new LineSegments(new EdgesGeometry(geometry, EDGE_ANGLE), new LineBasicMaterial({ color: colour, clippingPlanes })));
    }
  }

  turn(angle) {
    this.turning.rotation.z = angle;
  }

  cutAt(z) {
    this.plane.constant = z;
  }

  dispose() {
    this.group.traverse((one) => {
      one.geometry?.dispose();
      one.material?.dispose();
    });
  }
}
