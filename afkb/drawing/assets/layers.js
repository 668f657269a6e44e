// The checkboxes that show and hide what the plan is made of.

export function letHide(board) {
  const boxes = board.section.querySelector(".layers");
  boxes.hidden = false;
  const set = (box) => board.svg.classList.toggle(`hide-${box.dataset.layer}`, !box.checked);
  for (const box of boxes.querySelectorAll("input")) set(box);
  boxes.addEventListener("change", (event) => set(event.target));
}
