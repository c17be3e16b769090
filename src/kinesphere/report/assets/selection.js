/* What is picked: player, charts, tables and the list say the same. */
class Selection {
  constructor(scene, data, player, charts, track, redraw) {
    Object.assign(this, { scene, player, charts, track, redraw });
    this.list = document.querySelector("#pick");
    this.told = document.querySelector("#told");
    this.sources = scene.joints.map((joint, i) => [
      ...joint.axes.map((_, k) => [`axis ${k + 1}`, data.angles, 3 * i + k, "°"]),
      ["twist", data.twists, i, "°"], ["residual", data.joint_residuals, i, " mm"],
    ]);
    this.offer("Joints", "joint", scene.joints.map((joint) => joint.name.replaceAll("_", " ")));
    this.offer("Markers", "marker", scene.markers.map((marker) => marker.label));
    player.onpick = (picked) => this.pick(picked);
    this.list.addEventListener("change", () => {
      const [kind, index] = this.list.value.split(" ");
      this.pick(kind ? { kind, index: Number(index) } : null);
    });
    document.querySelectorAll(".chart[data-joint] h3, tr[data-joint] th").forEach((head) =>
      head.addEventListener("click", () =>
        this.pick({ kind: "joint", index: Number(head.closest("[data-joint]").dataset.joint) }, false)));
  }
  offer(label, kind, entries) {
    const group = document.createElement("optgroup");
    group.label = label;
    entries.forEach((name, i) => group.append(new Option(name, `${kind} ${i}`)));
    if (entries.length) this.list.append(group);
  }
  pick(picked, show = true) {
    this.player.picked = picked;
    const joint = picked?.kind === "joint" ? picked.index : -1;
    this.list.value = picked && picked.kind !== "limb" ? `${picked.kind} ${picked.index}` : "";
    this.charts.forEach((chart) => {
      chart.element.classList.toggle("picked", chart.index === joint);
      if (show && chart.index === joint) chart.element.scrollIntoView({ block: "nearest" });
    });
    document.querySelectorAll("tr[data-joint]").forEach((row) =>
      row.classList.toggle("picked", Number(row.dataset.joint) === joint));
    this.track.element.hidden = picked?.kind !== "marker";
    if (picked?.kind === "marker") this.track.show(picked.index);
    this.redraw();
  }
  /* Pick the joint so many further in the list. */
  step(by) {
    const n = this.scene.joints.length;
    const { picked } = this.player;
    const from = picked?.kind === "joint" ? picked.index : by > 0 ? -1 : 0;
    if (n) this.pick({ kind: "joint", index: (from + by + n) % n });
  }
  tell(frame) {
    const { player } = this;
    const { picked } = player;
    let told = "Click a joint or a marker, or choose it here.";
    if (picked?.kind === "joint") {
      told = this.sources[picked.index].map(([name, array, series, unit]) => {
        const v = array.at(series, frame);
        return `${name} ${Number.isFinite(v) ? v.toFixed(1) + unit : "–"}`;
      }).join(" · ");
    } else if (picked?.kind === "marker") {
      const p = player.point("markers", picked.index, frame);
      told = p ? ["x", "y", "z"].map((axis, k) => `${axis} ${(1000 * p[k]).toFixed(0)}`).join(" · ") + " mm" : "unseen";
    } else if (picked) told = player.picker.name(picked);
    this.told.textContent = told;
  }
}
