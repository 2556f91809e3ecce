// Without this script the pictures stand side by side.
document.documentElement.classList.add("js");
for (const slider of document.querySelectorAll(".slider")) {
  const input = slider.querySelector("input");
  const stack = slider.querySelector(".stack");
  const move = () => stack.style.setProperty("--at", input.value + "%");
  input.addEventListener("input", move);
  move();
  // The line over the pictures can be dragged as well.
  const follow = (event) => {
    const { left, width } = stack.getBoundingClientRect();
    input.value = 100 * (event.clientX - left) / width;
    move();
  };
  stack.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    stack.setPointerCapture(event.pointerId);
    follow(event);
  });
  stack.addEventListener("pointermove", (event) => {
    if (stack.hasPointerCapture(event.pointerId)) follow(event);
  });
  stack.addEventListener("dragstart", (event) => event.preventDefault());
}
addEventListener("beforeprint", () => {
  for (const details of document.querySelectorAll("details")) details.open = true;
});
