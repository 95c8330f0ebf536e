// A rotatable 3D view of one deformed surface at a time, animated with its mode shape.
"use strict";
function makeView(figure, scenes, { numbers, exact, element, rounded, paint }) {
  const stage = figure.querySelector(".stage"), caption = figure.querySelector("figcaption");
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  const period_ms = 1600;
  let shown = 0, amplitude = 1, playing = !still, phase = Math.PI / 2, visible = true;
  let renderer = null, camera, controls, mesh, outline, world, before = 0;

  // Vertices of the triangles; with colours per cell, each triangle has its own vertices.
  function shape(scene) {
    const points = numbers(scene.points), moves = numbers(scene.moves);
    const triangles = Uint32Array.from(numbers(scene.triangles)), values = numbers(scene.values);
    if (!scene.of_cells) return { rest: points, moves, values, index: triangles };
    const spread = (list) => Float32Array.from({ length: 3 * triangles.length }, (_, i) => list[3 * triangles[Math.floor(i / 3)] + (i % 3)]);
    return { rest: spread(points), moves: spread(moves), values: Float32Array.from(triangles, (_, i) => values[Math.floor(i / 3)]), index: null };
  }

  function colourList(scene, values) {
    const table = scene.colours.map((text) => new THREE.Color(text)), [least, most] = scene.range;
    const list = new Float32Array(3 * values.length);
    values.forEach((value, i) => {
      const place = Math.round(((value - least) / (most - least)) * (table.length - 1));
      table[Math.min(table.length - 1, Math.max(0, place))].toArray(list, 3 * i);
    });
    return list;
  }

  function load(number) {
    shown = number;
    const scene = scenes[number];
    caption.textContent = scene.title + ". " + scene.caption;
    if (!renderer) return;
    if (mesh) {
      world.remove(mesh, outline);
      mesh.geometry.dispose();
      outline.geometry.dispose();
    }
    const made = shape(scene), geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(made.rest), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(colourList(scene, made.values), 3));
    if (made.index) geometry.setIndex(new THREE.BufferAttribute(made.index, 1));
    mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide }));
    mesh.frustumCulled = false;
    mesh.userData = made;
    const lines = new THREE.BufferGeometry();
    lines.setAttribute("position", new THREE.BufferAttribute(new Float32Array(numbers(scene.outline)), 3));
    outline = new THREE.LineSegments(lines, new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55 }));
    world.add(mesh, outline);
    colour();
    showBar(scene);
    deform();
  }

  function deform() {
    const { rest, moves } = mesh.userData, position = mesh.geometry.attributes.position;
    const part = amplitude * Math.sin(phase);
    for (let i = 0; i < rest.length; ++i) position.array[i] = rest[i] + part * moves[i];
    position.needsUpdate = true;
    mesh.geometry.computeVertexNormals();
    render();
  }

  function render() {
    renderer.render(world, camera);
  }

  function lookAtAll() {
    const box = new THREE.Box3();
    scenes.forEach((scene) => {
      const points = numbers(scene.points), moves = numbers(scene.moves), v = new THREE.Vector3();
      for (let i = 0; i < points.length; i += 3)
        for (const s of [-1, 1])
          box.expandByPoint(v.set(points[i] + s * moves[i], points[i + 1] + s * moves[i + 1], points[i + 2] + s * moves[i + 2]));
    });
    const ball = box.getBoundingSphere(new THREE.Sphere());
    const away = (1.05 * ball.radius) / Math.sin((camera.fov * Math.PI) / 360) / Math.min(1, 1.3 * camera.aspect);
    camera.near = away / 100;
    camera.far = away * 10;
    camera.position.copy(ball.center).add(new THREE.Vector3(0.45, -1, 0.3).normalize().multiplyScalar(away));
    camera.updateProjectionMatrix();
    controls.target.copy(ball.center);
    controls.update();
  }

  function turn(around, up, nearer) {
    const arm = new THREE.Vector3().subVectors(camera.position, controls.target);
    const side = new THREE.Vector3().crossVectors(camera.up, arm).normalize();
    arm.applyAxisAngle(camera.up, around);
    const tilted = arm.clone().applyAxisAngle(side, up), slope = tilted.angleTo(camera.up);
    if (slope > 0.05 && slope < Math.PI - 0.05) arm.copy(tilted);
    camera.position.copy(controls.target).add(arm.multiplyScalar(nearer));
    controls.update();
    render();
  }

  function size() {
    const width = stage.clientWidth, height = Math.round(Math.min(460, Math.max(260, 0.62 * width)));
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    if (mesh) render();
  }

  function begin() {
    const probe = document.createElement("canvas");
    if (!probe.getContext("webgl2") && !probe.getContext("webgl")) return false;
    try {
      renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    } catch (error) {
      return false;
    }
    renderer.setPixelRatio(Math.min(2, devicePixelRatio));
    const canvas = renderer.domElement;
    for (const [name, value] of Object.entries({ tabindex: "0", role: "img", "aria-label": "3D view: " + scenes.map((s) => s.title).join("; ") + ". Arrow keys rotate the view, plus and minus keys zoom." }))
      canvas.setAttribute(name, value);
    stage.append(canvas);
    world = new THREE.Scene();
    camera = new THREE.PerspectiveCamera(32, 1.6, 0.01, 100);
    camera.up.set(0, 0, 1);
    world.add(new THREE.AmbientLight(0xffffff, 0.62), camera);
    const lamp = new THREE.DirectionalLight(0xffffff, 0.5);
    lamp.position.set(-0.6, 0.8, 1);
    camera.add(lamp);
    controls = new THREE.OrbitControls(camera, canvas);
    controls.enableKeys = false;
    controls.enableZoom = false;  // until the view has the focus: the wheel scrolls the page
    controls.addEventListener("change", () => { if (mesh) render(); });
    canvas.addEventListener("pointerdown", () => canvas.focus());
    canvas.addEventListener("focus", () => { controls.enableZoom = true; });
    canvas.addEventListener("blur", () => { controls.enableZoom = false; });
    canvas.addEventListener("keydown", key);
    size();
    lookAtAll();
    new ResizeObserver(size).observe(stage);
    new IntersectionObserver((seen) => { visible = seen[seen.length - 1].isIntersecting; }).observe(stage);
    figure.classList.add("shown");
    return true;
  }

  function key(event) {
    const step = 0.12;
    const action = { ArrowLeft: [-step, 0, 1], ArrowRight: [step, 0, 1], ArrowUp: [0, -step, 1], ArrowDown: [0, step, 1], "+": [0, 0, 0.9], "=": [0, 0, 0.9], "-": [0, 0, 1.1] }[event.key];
    if (!action) return;
    turn(...action);
    event.preventDefault();
  }

  let bar = null;
  function showBar(scene) {
    const made = element("div", { class: "bar" }, ...[scene.colour_label || "Colour", rounded(scene.range[0], 3)].map((text) => element("span", {}, text)),
      element("i"), element("span", {}, rounded(scene.range[1], 3)));
    made.querySelector("i").style.background = "linear-gradient(90deg," + scene.colours.join(",") + ")";
    if (bar) bar.replaceWith(made);
    else stage.after(made);
    bar = made;
  }

  function addTools() {
    const tools = figure.querySelector(".tools");
    const play = element("button", { type: "button" }, playing ? "Pause" : "Play");
    play.addEventListener("click", () => {
      playing = !playing;
      play.textContent = playing ? "Pause" : "Play";
    });
    const slider = element("input", { type: "range", min: "0", max: "2", step: "0.05", value: "1" });
    slider.addEventListener("input", () => { amplitude = Number(slider.value); deform(); });
    const whole = element("button", { type: "button" }, "Reset view");
    whole.addEventListener("click", () => { lookAtAll(); render(); });
    const parts = [play, element("label", {}, "Amplitude", slider), whole];
    if (scenes.length > 1) {
      const choice = element("select", {}, ...scenes.map((scene, i) => element("option", { value: String(i) }, scene.title)));
      choice.addEventListener("change", () => load(Number(choice.value)));
      parts.unshift(element("label", {}, "Shape", choice));
    }
    tools.prepend(...parts);
  }

  function frame(now) {
    const passed = Math.min(100, now - before);
    before = now;
    if (playing && visible) {
      phase = (phase + (2 * Math.PI * passed) / period_ms) % (2 * Math.PI);
      deform();
    }
    requestAnimationFrame(frame);
  }

  function colour() {
    if (outline) outline.material.color.set(paint("--quiet"));
    if (mesh) render();
  }

  function csv() {
    const scene = scenes[shown], { rest, moves, values } = shape(scene), lines = ["x,y,z,ux,uy,uz," + scene.csv + "\n"];
    for (let i = 0; i < values.length; ++i)
      lines.push([...rest.slice(3 * i, 3 * i + 3), ...moves.slice(3 * i, 3 * i + 3).map((m) => m / scene.scale), values[i]].map(exact).join(",") + "\n");
    return { name: scene.name, text: lines.join("") };
  }

  const works = begin();
  load(0);
  if (works) {
    addTools();
    requestAnimationFrame(frame);
  }
  return { colour, csv, works, state: () => ({ shown, playing, phase, triangles: works ? numbers(scenes[shown].triangles).length / 3 : 0 }), still };
}
