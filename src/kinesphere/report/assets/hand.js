/* The hand on the camera: drag turns, Shift-drag or two fingers move, wheel or pinch zooms, and a
   press that goes nowhere picks. */
class Hand {
  constructor(player) {
    const held = new Map();
    const canvas = player.canvas;
    let travelled = 0;
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      travelled = held.size ? Infinity : 0;
      held.set(event.pointerId, [event.offsetX, event.offsetY]);
    });
    const release = (event) => held.delete(event.pointerId);
    canvas.addEventListener("pointerup", (event) => {
      release(event); // a press that went nowhere points at something
      if (travelled < 5) player.onpick(player.picker.nearest(event.offsetX, event.offsetY));
    });
    canvas.addEventListener("pointerleave", () => player.pointAt(null));
    canvas.addEventListener("pointercancel", release);
    canvas.addEventListener("pointermove", (event) => {
      const before = held.get(event.pointerId);
      if (!before) {
        if (event.pointerType === "mouse") player.pointAt(player.picker.nearest(event.offsetX, event.offsetY));
        return;
      }
      const now = [event.offsetX, event.offsetY];
      const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
      travelled += Math.hypot(dx, dy);
      if (held.size === 2) {
        const [other] = [...held].filter(([id]) => id !== event.pointerId).map(([, p]) => p);
        const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
        player.zoom(apart(before) / apart(now));
        player.camera.pan(dx / 2, dy / 2);
      } else if (event.shiftKey || event.buttons & 6) {
        player.camera.pan(dx, dy);
      } else {
        player.orbit(-dx * 0.008, dy * 0.008);
      }
      held.set(event.pointerId, now);
      player.draw();
    });
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      player.zoom(Math.exp(Math.max(-60, Math.min(60, event.deltaY)) * 0.0022));
      player.draw();
    }, { passive: false });
    canvas.addEventListener("dblclick", () => player.reset());
  }
}
