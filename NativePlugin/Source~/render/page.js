// SPDX-License-Identifier: MIT
// Shows the meshes of a page (page_mesh.cpp) in the light of look.h, with three.js.
(function () {
  'use strict';

  const byId = (id) => document.getElementById(id);
  const view = byId('view'), told = view.dataset;
  const numbers = (text) => text.split(' ').map(Number);
  const vector = (text) => new THREE.Vector3(...numbers(text));
  const meshes = [...document.querySelectorAll('script.mesh')];

  const complain = (sentence) => {
    byId('trouble').hidden = false;
    byId('trouble').textContent = sentence;
  };

  const bytesOf = (text) => {
    const binary = atob(text), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
    return bytes;
  };

  const geometryOf = (element) => {
    const count = Number(element.dataset.vertices), corners = 3 * Number(element.dataset.triangles);
    const bytes = bytesOf(element.textContent), geometry = new THREE.BufferGeometry();
    const add = (name, array, size) => geometry.setAttribute(name, new THREE.BufferAttribute(array, size, true));
    add('position', new Uint16Array(bytes.buffer, 0, 3 * count), 3);
    add('octahedral', new Int8Array(bytes.buffer, 6 * count, 2 * count), 2);
    add('tint', new Uint8Array(bytes.buffer, 8 * count, 4 * count), 4);
    const indices = new Uint32Array(corners);
    let at = 12 * count, before = 0;
    for (let i = 0; i < corners; ++i) {
      let number = 0, factor = 1, byte;
      do {
        byte = bytes[at++];
        number += (byte & 127) * factor;
        factor *= 128;
      } while (byte & 128);
      before += number % 2 ? -(number + 1) / 2 : number / 2;
      indices[i] = before;
    }
    geometry.setIndex(new THREE.BufferAttribute(indices, 1));
    return geometry;
  };

  const material = () => new THREE.ShaderMaterial({
    uniforms: {
      low: {value: new THREE.Vector3()}, span: {value: new THREE.Vector3(1, 1, 1)},
      lamp: {value: vector(told.lamp).normalize()},
    },
    vertexShader: `
      attribute vec2 octahedral;
      attribute vec4 tint;
      uniform vec3 low, span;
      varying vec3 color, normalSeen;
      varying float open;
      vec3 linear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
      void main() {
        vec3 n = vec3(octahedral, 1.0 - abs(octahedral.x) - abs(octahedral.y));
        if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
        normalSeen = normalMatrix * normalize(n);
        color = linear(mix(tint.rgb, vec3(0.85), 0.2));
        open = tint.a;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(low + span * position, 1.0);
      }`,
    // Without shadows: where the sky is hidden, the lamp mostly is, too.
    fragmentShader: `
      uniform vec3 lamp;
      varying vec3 color, normalSeen;
      varying float open;
      void main() {
        vec3 n = normalize(normalSeen);
        float seen = min(1.0, 1.3 * open);
        vec3 sky = mix(vec3(0.78, 0.74, 0.72), vec3(0.92, 0.97, 1.05), 0.5 + 0.5 * n.y);
        float lit = seen * max(0.0, dot(n, lamp));
        float shine = 0.05 * seen * pow(max(0.0, dot(n, normalize(lamp + vec3(0.0, 0.0, 1.0)))), 28.0) +
            0.05 * open * pow(1.0 - clamp(n.z, 0.0, 1.0), 4.0);
        vec3 v = color * (sky * (0.82 * pow(max(open, 0.0), 1.15)) + vec3(1.02, 0.98, 0.92) * (0.78 * lit)) + shine;
        v = mix(v, 0.6 + 0.4 * (1.0 - exp((0.6 - v) / 0.4)), step(0.6, v));
        v = mix(12.92 * v, 1.055 * pow(max(v, 0.0), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, v));
        gl_FragColor = vec4(v, 1.0);
      }`,
  });

  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({antialias: true});
  } catch (error) {
    complain('This browser has no WebGL, which the page needs to show the surface.');
    return;
  }
  if (!meshes.length) {
    complain('There is no surface in this page.');
    return;
  }
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
  renderer.setClearColor(told.background);
  view.appendChild(renderer.domElement);

  const distance = Number(told.distance), half = numbers(told.half);
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera();
  const shown = new THREE.Mesh(new THREE.BufferGeometry(), material());
  shown.frustumCulled = false;
  scene.add(shown);
  const controls = new THREE.TrackballControls(camera, view);
  Object.assign(controls, {rotateSpeed: 3, zoomSpeed: 1.2, panSpeed: 0.3, staticMoving: true});
  controls.minDistance = distance / 50;
  controls.maxDistance = distance * 5;
  controls.keys = [];

  let stale = true;
  const reset = () => {
    controls.update();  // what a hand did before must not come after
    controls.target.set(0, 0, 0);
    camera.position.copy(vector(told.toward).multiplyScalar(distance));
    camera.up.copy(vector(told.up));
    camera.lookAt(controls.target);
    stale = true;
  };
  const resize = () => {
    const width = Math.max(1, window.innerWidth), height = Math.max(1, window.innerHeight);
    renderer.setSize(width, height);
    camera.aspect = width / height;
    const tall = Math.max(half[1], half[0] * height / width);
    camera.fov = THREE.Math.radToDeg(2 * Math.atan(tall / distance));
    controls.handleResize();
    stale = true;
  };
  window.addEventListener('resize', resize);
  view.addEventListener('dblclick', reset);
  controls.addEventListener('change', () => { stale = true; });

  // Frames that were shown are kept, up to some bytes of the page.
  const kept = new Map();
  let keptSize = 0, current = -1;
  const show = (number) => {
    const element = meshes[number];
    let geometry = kept.get(number);
    if (!geometry) {
      geometry = geometryOf(element);
      for (const [old, other] of kept) {
        if (keptSize < 2e8) break;
        kept.delete(old);
        keptSize -= meshes[old].textContent.length;
        other.dispose();
      }
      kept.set(number, geometry);
      keptSize += element.textContent.length;
    }
    shown.geometry = geometry;
    shown.material.uniforms.low.value.copy(vector(element.dataset.low));
    shown.material.uniforms.span.value.copy(vector(element.dataset.span));
    byId('triangles').textContent = Number(element.dataset.triangles).toLocaleString('en');
    byId('label').textContent = element.dataset.label;
    byId('slider').value = number;
    current = number;
    stale = true;
  };

  const play = byId('play'), framesPerSecond = 12;
  const step = (by) => show((current + by + meshes.length) % meshes.length);
  let playing = false, timer;
  const setPlaying = (now) => {
    playing = now;
    clearInterval(timer);
    if (playing) timer = setInterval(() => step(1), 1000 / framesPerSecond);
    play.textContent = playing ? '\u275a\u275a' : '\u25b6';
    play.setAttribute('aria-label', playing ? 'Pause' : 'Play');
  };
  if (meshes.length > 1) {
    byId('player').hidden = false;
    byId('slider').max = meshes.length - 1;
    byId('slider').addEventListener('input', (event) => {
      setPlaying(false);
      show(Number(event.target.value));
    });
    play.addEventListener('click', () => setPlaying(!playing));
    window.addEventListener('keydown', (event) => {
      // The slider has keys of its own, and so has a button that was clicked.
      if (event.target === byId('slider') || (event.target === play && event.key === ' ')) return;
      if (event.key === ' ') setPlaying(!playing);
      else if (event.key === 'ArrowRight') step(1);
      else if (event.key === 'ArrowLeft') step(-1);
      else return;
      event.preventDefault();
    });
  }

  const tick = () => {
    window.requestAnimationFrame(tick);
    controls.update();
    if (!stale) return;
    stale = false;
    const away = camera.position.length(), radius = distance / 6;
    camera.near = Math.max(away - 3 * radius, radius / 100);
    camera.far = away + 3 * radius;
    camera.updateProjectionMatrix();
    renderer.render(scene, camera);
  };

  resize();
  reset();
  // "page.html#3" begins with the third frame.
  const asked = parseInt(location.hash.slice(1), 10);
  show(asked >= 1 && asked <= meshes.length ? asked - 1 : 0);
  tick();
})();
