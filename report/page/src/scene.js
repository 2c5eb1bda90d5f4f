// SPDX-License-Identifier: MIT
// The head in 3D with its markers: turn it, play the window.
import {
  BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, FrontSide, GreaterDepth,
  HemisphereLight, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, MeshStandardMaterial, PerspectiveCamera, Raycaster, Scene, SphereGeometry,
  Vector2, Vector3, WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

import {numbersOf} from './data.js';
import {Rig} from './rig.js';
import {element, formatFixed} from './text.js';

const kMeasuredColor = 0xffffff;
const kVirtualColor = 0xff7a1a;
const kMarkerRadius_mm = 2.1;
const kInnerParts = ['teeth', 'tongue', 'eyes', 'mouth'];

/**
 * Balls at given places; those behind the skin shine through faintly. `lift` brings them to the
 * front by some millimetres, so that a small ball within a larger one is seen as its core.
 */
class MarkerCloud {
  constructor(count, color, radius, lift = 0) {
    this.count = count;
    this.radius = radius;
    this.positions = new Float32Array(3 * count).fill(NaN);
    const ball = new SphereGeometry(1, 20, 14);
    this.mesh = new InstancedMesh(
        ball, new MeshStandardMaterial({
          color, roughness: 0.45, emissive: color, emissiveIntensity: 0.35,
          polygonOffset: true, polygonOffsetUnits: -500 * lift,
        }), count);
    this.mesh.renderOrder = 3 + lift;
    this.ghost = new InstancedMesh(
        ball, new MeshBasicMaterial({color, transparent: true, opacity: 0.22, depthFunc: GreaterDepth, depthWrite: false}),
        count);
    this.ghost.renderOrder = 8;
    for (const mesh of [this.mesh, this.ghost]) mesh.frustumCulled = false;
  }

  update(highlighted) {
    const matrix = new Matrix4();
    for (let i = 0; i < this.count; ++i) {
      const isThere = Number.isFinite(this.positions[3 * i]);
      const size = isThere ? this.radius * (i === highlighted ? 1.8 : 1) : 0;
      matrix.makeScale(size, size, size);
      if (isThere) matrix.setPosition(...this.positions.subarray(3 * i, 3 * i + 3));
      this.mesh.setMatrixAt(i, matrix);
      this.ghost.setMatrixAt(i, matrix);
    }
    this.mesh.instanceMatrix.needsUpdate = true;
    this.ghost.instanceMatrix.needsUpdate = true;
    this.mesh.boundingSphere = null;
  }

  set visible(visible) {
    this.mesh.visible = visible;
    this.ghost.visible = visible;
  }
}

export class HeadScene {
  constructor(packed, clock) {
    this.clock = clock;
    this.first = packed.first;
    this.stride = packed.stride;
    this.count = packed.count;
    this.markerNames = packed.marker_names;
    this.measured = packed.measured && numbersOf(packed.measured);
    this.virtual = packed.virtual && numbersOf(packed.virtual);
    this.rig = packed.rig && new Rig(packed.rig);
    this.rigValues = packed.rig_values.map((values) => values && numbersOf(values));
    this.rigIsTooLarge = packed.rig_is_too_large;
    this.opacity = 1;
    this.hiddenParts = new Set();
    this.needsRender = true;
  }

  /** Builds the picture in the element; false where the browser has no WebGL. */
  mount(container) {
    this.container = container;
    try {
      this.renderer = new WebGLRenderer({antialias: true, alpha: true, preserveDrawingBuffer: true});
    } catch {
      return false;
    }
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    container.prepend(this.renderer.domElement);
    this.tip = element('div', {class: 'tip', hidden: true});
    container.append(this.tip);
    this.scene = new Scene();
    this.addLights();
    this.addHead();
    this.addMarkers();
    this.addCamera();
    new ResizeObserver(() => this.resize()).observe(container);
    this.renderer.domElement.addEventListener('pointermove', (event) => this.pick(event));
    this.renderer.domElement.addEventListener('pointerleave', () => this.clock.setMarker(null));
    this.clock.on('frame', () => this.showFrame());
    this.clock.on('marker', () => this.showFrame());
    this.resize();
    this.showFrame();
    const draw = () => {
      this.controls.update();
      if (this.needsRender) this.renderer.render(this.scene, this.camera);
      this.needsRender = false;
      requestAnimationFrame(draw);
    };
    draw();
    return true;
  }

  addLights() {
    this.scene.add(new HemisphereLight(0xf4f7ff, 0x6b5a50, 1.25));
    const key = new DirectionalLight(0xfff2e4, 1.9);
    key.position.set(-0.7, 0.9, 1.2);
    const fill = new DirectionalLight(0xdfe9ff, 0.55);
    fill.position.set(1.2, 0.1, 0.7);
    const rim = new DirectionalLight(0xffffff, 0.8);
    rim.position.set(0.4, 0.9, -1.3);
    this.scene.add(key, fill, rim);
  }

  addHead() {
    this.parts = new Map();
    if (!this.rig) return;
    this.positionAttribute = new BufferAttribute(this.rig.positions, 3);
    this.normalAttribute = new BufferAttribute(this.rig.normals, 3);
    const colors = new BufferAttribute(this.rig.colors, 3);
    for (const {name, corners} of this.rig.parts) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', this.positionAttribute);
      geometry.setAttribute('normal', this.normalAttribute);
      geometry.setAttribute('color', colors);
      geometry.setIndex(new BufferAttribute(corners, 1));
      const isGlossy = name.includes('eye') || name === 'teeth' || name === 'tongue';
      const material = new MeshStandardMaterial(
          {vertexColors: true, roughness: isGlossy ? 0.3 : 0.62, side: DoubleSide});
      const mesh = new Mesh(geometry, material);
      mesh.frustumCulled = false;
      // What lies inside is drawn first, so that a transparent skin shows it.
      mesh.renderOrder = kInnerParts.some((inner) => name.includes(inner)) ? 0 : 1;
      this.parts.set(name, mesh);
      this.scene.add(mesh);
    }
  }

  addMarkers() {
    const count = this.markerNames.length;
    this.measuredCloud = new MarkerCloud(count, kMeasuredColor, kMarkerRadius_mm);
    this.virtualCloud = new MarkerCloud(count, kVirtualColor, 0.6 * kMarkerRadius_mm, 4);
    this.linePositions = new BufferAttribute(new Float32Array(6 * count), 3);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.linePositions);
    this.lines = new LineSegments(
        geometry, new LineBasicMaterial({color: kVirtualColor, depthTest: false, transparent: true}));
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 9;
    for (const cloud of [this.measuredCloud, this.virtualCloud])
      this.scene.add(cloud.mesh, cloud.ghost);
    this.scene.add(this.lines);
  }

  /** The middle and the radius of what there is to see. */
  bounds() {
    const low = new Vector3(Infinity, Infinity, Infinity);
    const high = new Vector3(-Infinity, -Infinity, -Infinity);
    const points = this.rig ? this.rig.neutral : this.measured ?? this.virtual ?? [];
    const point = new Vector3();
    for (let i = 0; i + 2 < points.length; i += 3) {
      if (!Number.isFinite(points[i])) continue;
      point.set(points[i], points[i + 1], points[i + 2]);
      low.min(point);
      high.max(point);
    }
    if (low.x > high.x) return {center: new Vector3(), radius: 100};
    return {
      center: low.clone().add(high).multiplyScalar(0.5),
      radius: Math.max(20, 0.5 * high.y - 0.5 * low.y, 0.5 * high.x - 0.5 * low.x),
    };
  }

  addCamera() {
    const {center, radius} = this.bounds();
    this.radius = radius;
    this.camera = new PerspectiveCamera(24, 1, radius / 20, radius * 60);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.target.copy(center);
    this.controls.minDistance = 0.8 * radius;
    this.controls.maxDistance = 20 * radius;
    this.controls.addEventListener('change', () => { this.needsRender = true; });
    this.look(28, 6);
  }

  /** Looks from so many degrees to the speaker's left and above. */
  look(azimuth, elevation) {
    const a = azimuth * Math.PI / 180;
    const e = elevation * Math.PI / 180;
    const distance = 1.12 * this.radius / Math.tan(this.camera.fov * Math.PI / 360);
    this.camera.position.copy(this.controls.target).addScaledVector(
        new Vector3(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e)), distance);
    this.controls.update();
    this.needsRender = true;
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.container;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // A narrow picture must still hold the width of a head.
    this.camera.zoom = Math.min(1, 1.15 * this.camera.aspect);
    this.camera.updateProjectionMatrix();
    this.needsRender = true;
  }

  /** The sample of the window that the page's frame shows. */
  sample() {
    const sample = Math.round((this.clock.frame - this.first) / this.stride);
    return Math.max(0, Math.min(this.count - 1, sample));
  }

  showFrame() {
    const sample = this.sample();
    if (this.rig && sample !== this.posedSample) {
      this.rig.pose(this.rigValues.map((values) => (values && Number.isFinite(values[sample]) ? values[sample] : 0)));
      this.positionAttribute.needsUpdate = true;
      this.normalAttribute.needsUpdate = true;
    }
    this.posedSample = sample;
    const highlighted = this.markerNames.indexOf(this.clock.marker);
    const size = 3 * this.markerNames.length;
    for (const [cloud, positions] of [[this.measuredCloud, this.measured], [this.virtualCloud, this.virtual]]) {
      if (positions) cloud.positions.set(positions.subarray(sample * size, (sample + 1) * size));
      cloud.update(highlighted);
    }
    this.updateLines();
    this.needsRender = true;
  }

  updateLines() {
    const out = this.linePositions.array;
    const a = this.measuredCloud.positions;
    const b = this.virtualCloud.positions;
    for (let i = 0; i < this.markerNames.length; ++i) {
      const areThere = Number.isFinite(a[3 * i]) && Number.isFinite(b[3 * i]);
      for (let k = 0; k < 3; ++k) {
        out[6 * i + k] = areThere ? a[3 * i + k] : 0;
        out[6 * i + 3 + k] = areThere ? b[3 * i + k] : 0;
      }
    }
    this.linePositions.needsUpdate = true;
  }

  /** Distance of measured to virtual marker in the frame shown, mm of the rig; NaN where not known. */
  distance(marker) {
    const a = this.measuredCloud.positions;
    const b = this.virtualCloud.positions;
    return Math.hypot(a[3 * marker] - b[3 * marker], a[3 * marker + 1] - b[3 * marker + 1],
                      a[3 * marker + 2] - b[3 * marker + 2]);
  }

  pick(event) {
    const box = this.container.getBoundingClientRect();
    const x = event.clientX - box.left;
    const y = event.clientY - box.top;
    const raycaster = new Raycaster();
    raycaster.setFromCamera(new Vector2(2 * x / box.width - 1, 1 - 2 * y / box.height), this.camera);
    const meshes = [this.measuredCloud.mesh, this.virtualCloud.mesh].filter((mesh) => mesh.visible);
    const hit = raycaster.intersectObjects(meshes, false)[0];
    const marker = hit ? hit.instanceId : -1;
    this.clock.setMarker(marker < 0 ? null : this.markerNames[marker]);
    this.tip.hidden = marker < 0;
    if (marker < 0) return;
    const distance = this.distance(marker);
    this.tip.textContent = this.markerNames[marker] +
        (Number.isFinite(distance) ? ` · ${formatFixed(distance, 2)} mm apart` : '');
    this.tip.style.left = `${Math.min(x, box.width - 150)}px`;
    this.tip.style.top = `${y}px`;
  }

  /** 1 solid, 0 gone; in between the inner parts stay solid behind a glassy skin. */
  setOpacity(opacity) {
    this.opacity = opacity;
    for (const [name, mesh] of this.parts) {
      const isInner = kInnerParts.some((inner) => name.includes(inner));
      mesh.material.transparent = opacity < 1 && !isInner;
      mesh.material.opacity = isInner ? 1 : opacity;
      mesh.material.side = opacity < 1 ? FrontSide : DoubleSide;
      mesh.material.needsUpdate = true;
    }
    this.updateParts();
  }

  show(what, visible) {
    if (what === 'measured') this.measuredCloud.visible = visible;
    else if (what === 'virtual') this.virtualCloud.visible = visible;
    else if (what === 'lines') this.lines.visible = visible;
    else if (visible) this.hiddenParts.delete(what);
    else this.hiddenParts.add(what);
    this.updateParts();
  }

  updateParts() {
    for (const [name, mesh] of this.parts)
      mesh.visible = this.opacity > 0 && !this.hiddenParts.has(name);
    this.needsRender = true;
  }
}

export const kLegendColors = {
  measured: `#${new Color(kMeasuredColor).getHexString()}`,
  virtual: `#${new Color(kVirtualColor).getHexString()}`,
};
