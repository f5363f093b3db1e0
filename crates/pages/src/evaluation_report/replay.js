"use strict";
// Boards step by step: the page can be read without this.
for (const box of document.querySelectorAll("details.replay")) {
  if (box.open) begin(box);
  else box.addEventListener("toggle", () => begin(box), { once: true });
}
function begin(box) {
  const data = JSON.parse(box.querySelector("script").textContent);
  const find = (name) => box.querySelector(name);
  const [svg, caption, slider, play] = ["svg", ".caption", "input", ".play"].map(find);
  const use = (mark) => {
    const [tile, x, y, w = data.cell, h = data.cell] = mark.split(",");
    return `<use href="#${data.prefix}${tile}" transform="translate(${x} ${y}) scale(${w} ${h})"/>`;
  };
  const boards = [];
  let marks = [];
  for (const change of data.changes) {
    marks = marks.slice();
    for (const line of change.split("\n").filter(Boolean)) {
      const [at, count, ...next] = line.split(" ");
      marks.splice(+at, +count, ...next.map(use));
    }
    boards.push(marks);
  }
  const last = boards.length - 1;
  let timer = 0;
  const stop = () => { clearInterval(timer); timer = 0; play.textContent = "play"; };
  const show = (at) => {
    const board = Math.max(0, Math.min(last, at));
    svg.innerHTML = boards[board].join("");
    caption.textContent = data.captions[board];
    slider.value = board;
    for (const old of box.querySelectorAll("li.now")) old.classList.remove("now");
    const words = find(`li[data-at="${board}"]`);
    if (words) {
      words.classList.add("now");
      const list = words.parentElement;
      list.scrollTop = words.offsetTop - list.offsetTop - list.clientHeight / 4;
    }
    if (board === last) stop();
  };
  slider.max = last;
  slider.addEventListener("input", () => { stop(); show(+slider.value); });
  find(".back").addEventListener("click", () => { stop(); show(+slider.value - 1); });
  find(".on").addEventListener("click", () => { stop(); show(+slider.value + 1); });
  play.addEventListener("click", () => {
    if (timer) return stop();
    if (+slider.value === last) show(0);
    play.textContent = "pause";
    timer = setInterval(() => show(+slider.value + 1), 200);
  });
  for (const words of box.querySelectorAll("li[data-at]")) {
    words.querySelector("b").addEventListener("click", () => { stop(); show(+words.dataset.at); });
  }
  find(".stage").hidden = false;
  show(0);
}
