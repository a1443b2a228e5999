// SPDX-License-Identifier: Apache-2.0
// The bar between text and views: dragged, or moved by arrow keys. Where it stands is kept by the browser.
import { byId } from "./dom";

const [least, most, usual] = [15, 85, 42]; // percent of the width

export function addSplitter(): void {
  const bar = byId("splitter");
  const whole = document.querySelector("main") as HTMLElement;
  const put = (share: number) => {
    const percent = Math.min(Math.max(Math.round(share * 10) / 10, least), most);
    whole.style.setProperty("--text", `${percent}fr`);
    whole.style.setProperty("--views", `${100 - percent}fr`);
    bar.setAttribute("aria-valuenow", String(percent));
    try {
      localStorage.setItem("takt-splitter", String(percent));
    } catch {
      // a browser that keeps nothing
    }
  };
  let kept: string | null = null;
  try {
    kept = localStorage.getItem("takt-splitter");
  } catch {
    // likewise
  }
  bar.setAttribute("aria-valuemin", String(least));
  bar.setAttribute("aria-valuemax", String(most));
  put(Number(kept ?? usual) || usual);
  bar.addEventListener("pointerdown", (down) => {
    bar.setPointerCapture(down.pointerId);
    const moved = (event: PointerEvent) => put((100 * event.clientX) / whole.clientWidth);
    bar.addEventListener("pointermove", moved);
    const up = () => bar.removeEventListener("pointermove", moved);
    bar.addEventListener("pointerup", up, { once: true });
    bar.addEventListener("pointercancel", up, { once: true });
  });
  bar.addEventListener("dblclick", () => put(usual));
  bar.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: -2, ArrowRight: 2 }[event.key];
    if (!step) return;
    event.preventDefault();
    put(Number(bar.getAttribute("aria-valuenow")) + step);
  });
}
