// Light, dark, or as the system has it; kept where the browser lets a page keep something.

const KEPT = "afkb-theme";
const NEXT = { auto: "light", light: "dark", dark: "auto" };
const TOLD = { auto: "as the system", light: "light", dark: "dark" };

export function letChooseTheme(button) {
  const root = document.documentElement;
  const set = (theme) => {
    if (theme === "auto") delete root.dataset.theme;
    else root.dataset.theme = theme;
    button.textContent = `Theme: ${TOLD[theme]}`;
    button.dataset.now = theme;
  };
  let kept = null;
  try {
    kept = localStorage.getItem(KEPT);
  } catch { /* A page from disk may have no place to keep it. */ }
  set(kept in NEXT ? kept : "auto");
  button.hidden = false;
  button.addEventListener("click", () => {
    const theme = NEXT[button.dataset.now];
    set(theme);
    try {
      localStorage.setItem(KEPT, theme);
    } catch { /* It holds for this look, then. */ }
  });
}
