
'use strict';
// The bed as spheres and the part as triangles, in one WebGL2 canvas. A sphere is a square that faces the eye; its pixels
// are cast against the true sphere, so that outlines, shading and depth are exact however close one looks.
(function () {
  const root = document.getElementById('viewer');
  if (!root) return;
  const canvas = root.querySelector('canvas');
  const data = JSON.parse(document.getElementById('bed-data').textContent);
  const counts = document.querySelector('.viewer-note .counts');
  const sorry = (words) => {
    const message = root.querySelector('.message');
    root.querySelector('.controls').hidden = root.querySelector('.key').hidden = true;
    message.textContent = words;
    message.hidden = false;
  };
  if (data.grains < data.all_grains) counts.textContent += `Showing ${data.grains} of ${data.all_grains} grains, those nearest to the middle of the plate. `;
  if (data.triangles < data.all_triangles) counts.textContent += `The mesh of ${data.all_triangles} triangles is too large for this page; open the STL file. `;

  const gl = canvas.getContext('webgl2', {antialias: true});
  if (!gl) {
    sorry('This browser offers no WebGL 2, so the interactive view cannot be drawn; the pictures show the same bed.');
    return;
  }

  // --- data ---------------------------------------------------------------------------------------------------------
  const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const buffer = (kind, array) => {
    const b = gl.createBuffer();
    gl.bindBuffer(kind, b);
    gl.bufferData(kind, array, gl.STATIC_DRAW);
    return b;
  };

  // --- shaders ------------------------------------------------------------------------------------------------------
  const common = `#version 300 es
    precision highp float;
    uniform mat4 view, projection;
    uniform vec3 low, size;
    uniform float lowest, highest;
    uniform sampler2D ramp;
    vec3 shade(vec3 base, vec3 normal, vec3 to_eye, float height, float gloss) {
      vec3 up = normalize(mat3(view) * vec3(0., 0., 1.));
      vec3 light = normalize(vec3(-.45, .55, .75));
      float sky = .5 + .5 * dot(normal, up);
      float sun = max(dot(normal, light), 0.);
      float shine = pow(max(dot(normal, normalize(light + to_eye)), 0.), 40.);
      float open = mix(.55, 1., smoothstep(0., 1., height));
      return pow(base * (.20 + .38 * sky * open + .62 * sun * open) + gloss * shine, vec3(.92));
    }
    float relative_height(float z) { return clamp((z - lowest) / max(highest - lowest, 1e-9), 0., 1.); }`;
  const sphere = {
    vertex: `${common}
      layout(location = 0) in vec2 corner;
      layout(location = 1) in vec3 centre01;
      layout(location = 2) in float radius01;
      uniform float largest_radius, smallest_radius;
      uniform bool by_height;
      out vec3 seen; flat out vec3 middle; flat out float radius; flat out vec3 base; flat out float height;
      void main() {
        vec3 centre = low + size * centre01;
        radius = largest_radius * radius01;
        height = relative_height(centre.z);
        float by_size = (radius - smallest_radius) / max(largest_radius - smallest_radius, 1e-9);
        base = texture(ramp, vec2(.03 + .94 * (by_height ? height : by_size), .5)).rgb;
        middle = (view * vec4(centre, 1.)).xyz;
        float d = length(middle);
        vec3 w = middle / d, u = normalize(cross(w, abs(w.y) < .9 ? vec3(0., 1., 0.) : vec3(1., 0., 0.))), v = cross(u, w);
        float reach = 1.04 * radius * d / sqrt(max(d * d - radius * radius, 1e-6));
        seen = middle + reach * (corner.x * u + corner.y * v);
        gl_Position = projection * vec4(seen, 1.);
      }`,
    fragment: `${common}
      in vec3 seen; flat in vec3 middle; flat in float radius; flat in vec3 base; flat in float height;
      out vec4 colour;
      void main() {
        vec3 ray = normalize(seen);
        float along = dot(ray, middle);
        float miss = length(middle - along * ray);           // distance of the ray from the centre
        float edge = clamp((radius - miss) / max(fwidth(miss), 1e-6) + .5, 0., 1.);
        if (edge <= 0.) discard;
        float half_chord = sqrt(max(radius * radius - miss * miss, 0.));
        vec3 hit = (along - half_chord) * ray;
        vec4 clip = projection * vec4(hit, 1.);
        gl_FragDepth = clamp(.5 * clip.z / clip.w + .5, 0., 1.);
        vec3 normal = normalize(hit - middle);
        colour = vec4(shade(base, normal, -ray, height, .22), edge);
      }`};
  const metal = {
    vertex: `${common}
      layout(location = 0) in vec3 corner01;
      out vec3 place, seen;
      void main() {
        place = low + size * corner01;
        seen = (view * vec4(place, 1.)).xyz;
        gl_Position = projection * vec4(seen, 1.);
      }`,
    fragment: `${common}
      in vec3 place, seen;
      uniform float plate_top;
      uniform bool by_height;
      out vec4 colour;
      void main() {
        vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
        if (dot(normal, seen) > 0.) normal = -normal;
        float raised = smoothstep(.5, 3., place.z - plate_top);
        vec3 base = mix(vec3(.40, .45, .51), vec3(.86, .57, .34), raised);
        if (by_height && raised > 0.) base = texture(ramp, vec2(.03 + .94 * relative_height(place.z), .5)).rgb;
        colour = vec4(shade(base, normal, -normalize(seen), 1., .10), 1.);
      }`};
  const program = (source) => {
    const p = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, source.vertex], [gl.FRAGMENT_SHADER, source.fragment]]) {
      const s = gl.createShader(kind);
      gl.shaderSource(s, text);
      gl.compileShader(s);
      gl.attachShader(p, s);
      if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(s));
    }
    gl.linkProgram(p);
    if (!gl.getProgramParameter(p, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(p));
    const at = {};
    for (let i = 0; i < gl.getProgramParameter(p, gl.ACTIVE_UNIFORMS); ++i) {
      const name = gl.getActiveUniform(p, i).name;
      at[name] = gl.getUniformLocation(p, name);
    }
    return {p, at};
  };
  let sphere_program, metal_program;
  try {
    sphere_program = program(sphere);
    metal_program = program(metal);
  } catch (error) {
    sorry(`This graphics driver cannot draw the interactive view (${error.message}); the pictures show the same bed.`);
    return;
  }

  const spheres = gl.createVertexArray();
  gl.bindVertexArray(spheres);
  buffer(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]));
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
  buffer(gl.ARRAY_BUFFER, bytes(data.centre));
  gl.enableVertexAttribArray(1);
  gl.vertexAttribPointer(1, 3, gl.UNSIGNED_SHORT, true, 0, 0);
  gl.vertexAttribDivisor(1, 1);
  buffer(gl.ARRAY_BUFFER, bytes(data.radius));
  gl.enableVertexAttribArray(2);
  gl.vertexAttribPointer(2, 1, gl.UNSIGNED_SHORT, true, 0, 0);
  gl.vertexAttribDivisor(2, 1);

  const triangles = gl.createVertexArray();
  gl.bindVertexArray(triangles);
  buffer(gl.ARRAY_BUFFER, bytes(data.corner));
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 3, gl.UNSIGNED_SHORT, true, 0, 0);
  buffer(gl.ELEMENT_ARRAY_BUFFER, bytes(data.triangle));
  gl.bindVertexArray(null);

  const ramp = bytes(data.ramp);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, ramp);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  root.querySelector('.key canvas').getContext('2d').putImageData(new ImageData(new Uint8ClampedArray(ramp), 256, 1), 0, 0);

  // --- camera: turns about a point on the plate -----------------------------------------------------------------------
  const top_z = Math.max(data.plate_top + 60, data.metal_high[2]);
  const lowest = data.plate_top, highest = Math.max(top_z, data.plate_top + 1);
  const middle = [0, 1].map((c) => .5 * (data.metal_low[c] + data.metal_high[c]));
  const extent = [0, 1].map((c) => data.metal_high[c] - data.metal_low[c]);
  const camera = {turn: -1.1, rise: .62, distance: 1, target: [0, 0, 0]};
  const field = .36;  // vertical field of view [rad]
  const look = (name) => {
    const turn = name === 'side' ? -Math.PI / 2 : name === 'top' ? -Math.PI / 2 : -1.15;
    const rise = name === 'side' ? .06 : name === 'top' ? Math.PI / 2 : .62;
    const aspect = canvas.clientWidth / Math.max(1, canvas.clientHeight);
    const across = Math.abs(Math.sin(turn)) * extent[0] + Math.abs(Math.cos(turn)) * extent[1];
    const deep = (Math.abs(Math.cos(turn)) * extent[0] + Math.abs(Math.sin(turn)) * extent[1]) * Math.sin(rise) + 120;
    const fit = Math.max(across / aspect, deep) / (2 * Math.tan(field / 2));
    Object.assign(camera, {turn, rise, distance: 1.12 * fit + .3 * extent[1] * Math.cos(rise), target: [...middle, data.plate_top]});
    draw();
  };
  const axes = () => {
    const {turn, rise} = camera, c = Math.cos, s = Math.sin;
    const back = [c(turn) * c(rise), s(turn) * c(rise), s(rise)];
    const right = [-s(turn), c(turn), 0];
    const up = [back[1] * right[2] - back[2] * right[1], back[2] * right[0] - back[0] * right[2], back[0] * right[1] - back[1] * right[0]];
    return {back, right, up};
  };
  const matrices = (aspect) => {
    const {back, right, up} = axes();
    const eye = camera.target.map((t, i) => t + camera.distance * back[i]);
    const dot = (a) => -(a[0] * eye[0] + a[1] * eye[1] + a[2] * eye[2]);
    const view = [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0, dot(right), dot(up), dot(back), 1];
    const reach = Math.hypot(...data.size) + Math.hypot(...eye.map((e, i) => e - data.low[i] - .5 * data.size[i]));
    const near = Math.max(camera.distance / 60, .5), far = reach + 10;
    const f = 1 / Math.tan(field / 2), a = (far + near) / (near - far), b = 2 * far * near / (near - far);
    return {view, projection: [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, a, -1, 0, 0, b, 0]};
  };

  // --- drawing, only when something changed ---------------------------------------------------------------------------
  const shown = {powder: true, part: true};
  let by_height = false, asked = false;
  const set_common = ({p, at}, {view, projection}) => {
    gl.useProgram(p);
    gl.uniformMatrix4fv(at.view, false, view);
    gl.uniformMatrix4fv(at.projection, false, projection);
    gl.uniform3fv(at.low, data.low);
    gl.uniform3fv(at.size, data.size);
    gl.uniform1f(at.lowest, lowest);
    gl.uniform1f(at.highest, highest);
    gl.uniform1i(at.by_height, by_height);
  };
  const render = () => {
    asked = false;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * scale));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * scale));
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    const m = matrices(canvas.width / canvas.height);
    if (shown.part && data.triangles) {
      set_common(metal_program, m);
      gl.uniform1f(metal_program.at.plate_top, data.plate_top);
      gl.bindVertexArray(triangles);
      gl.drawElements(gl.TRIANGLES, 3 * data.triangles, gl.UNSIGNED_INT, 0);
    }
    if (shown.powder && data.grains) {
      set_common(sphere_program, m);
      gl.uniform1f(sphere_program.at.largest_radius, data.largest_radius);
      gl.uniform1f(sphere_program.at.smallest_radius, data.smallest_radius);
      gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
      gl.bindVertexArray(spheres);
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, data.grains);
      gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
    }
  };
  function draw() {
    if (!asked) requestAnimationFrame(render);
    asked = true;
  }
  const legend = () => {
    const key = root.querySelector('.key');
    const [low, high] = by_height ? [0, highest - lowest] : [2 * data.smallest_radius, 2 * data.largest_radius];
    key.querySelector('.low').textContent = low.toFixed(0);
    key.querySelector('.what').textContent = by_height ? 'height above the plate [\u00b5m]' : 'grain diameter [\u00b5m]';
    key.querySelector('.high').textContent = high.toFixed(0);
  };

  // --- mouse, touch, keys ---------------------------------------------------------------------------------------------
  const zoom = (factor) => { camera.distance = Math.min(Math.max(camera.distance * factor, 20), 1e6); draw(); };
  const turn = (dx, dy) => {
    camera.turn -= .008 * dx;
    camera.rise = Math.min(Math.max(camera.rise + .008 * dy, -.2), Math.PI / 2);
    draw();
  };
  const move = (dx, dy) => {
    const {right, up} = axes(), step = 2 * camera.distance * Math.tan(field / 2) / canvas.clientHeight;
    camera.target = camera.target.map((t, i) => t - step * (dx * right[i] - dy * up[i]));
    draw();
  };
  const pointers = new Map();
  const spread = () => { const [a, b] = [...pointers.values()]; return Math.hypot(a.x - b.x, a.y - b.y); };
  canvas.addEventListener('pointerdown', (e) => {
    canvas.setPointerCapture(e.pointerId);
    pointers.set(e.pointerId, {x: e.clientX, y: e.clientY});
    canvas.focus({preventScroll: true});
  });
  canvas.addEventListener('pointermove', (e) => {
    const last = pointers.get(e.pointerId);
    if (!last) return;
    const dx = e.clientX - last.x, dy = e.clientY - last.y;
    const before = pointers.size === 2 ? spread() : 0;
    pointers.set(e.pointerId, {x: e.clientX, y: e.clientY});
    if (pointers.size === 2) {
      move(dx / 2, dy / 2);
      zoom(before / Math.max(spread(), 1));
    } else if (e.shiftKey || e.buttons & 6) {
      move(dx, dy);
    } else {
      turn(dx, dy);
    }
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, (e) => pointers.delete(e.pointerId));
  canvas.addEventListener('contextmenu', (e) => e.preventDefault());
  canvas.addEventListener('wheel', (e) => {
    if (document.activeElement !== canvas) return;  // the page scrolls until one clicks into the view
    e.preventDefault();
    zoom(Math.exp(.0012 * e.deltaY));
  }, {passive: false});
  canvas.addEventListener('keydown', (e) => {
    const steps = {ArrowLeft: [-12, 0], ArrowRight: [12, 0], ArrowUp: [0, -12], ArrowDown: [0, 12]};
    if (steps[e.key]) turn(...steps[e.key]);
    else if (e.key === '+' || e.key === '=') zoom(.85);
    else if (e.key === '-') zoom(1 / .85);
    else return;
    e.preventDefault();
  });
  root.querySelector('.controls').addEventListener('click', (e) => {
    const {colour, show, view} = e.target.dataset;
    if (colour) {
      by_height = colour === 'height';
      for (const b of root.querySelectorAll('[data-colour]')) b.classList.toggle('on', b === e.target);
      legend();
    }
    if (show) e.target.classList.toggle('on', shown[show] = !shown[show]);
    if (view) look(view);
    draw();
  });
  new ResizeObserver(draw).observe(canvas);
  legend();
  look('slant');
}());
