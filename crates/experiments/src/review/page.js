// Without this script the pictures stand side by side.
document.documentElement.classList.add("js");
for (const slider of document.querySelectorAll(".slider")) {
  const input = slider.querySelector("input");
  const stack = slider.querySelector(".stack");
  const move = () => stack.style.setProperty("--at", input.value + "%");
  input.addEventListener("input", move);
  move();
}
addEventListener("beforeprint", () => {
  for (const details of document.querySelectorAll("details")) details.open = true;
});
