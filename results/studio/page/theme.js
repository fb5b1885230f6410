// Light and dark: as the system says, or as chosen here.

const NEXT = { auto: "light", light: "dark", dark: "auto" };

export function follow(button) {
  let mode = localStorage.getItem("flexspline-theme");
  const system = matchMedia("(prefers-color-scheme: dark)");
  const apply = () => {
    const dark = mode === "dark" || (mode !== "light" && system.matches);
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    button.textContent = { light: "Light", dark: "Dark" }[mode] ?? "Auto";
  };
  button.addEventListener("click", () => {
    mode = NEXT[mode] ?? "light";
    localStorage.setItem("flexspline-theme", mode);
    apply();
  });
  system.addEventListener("change", apply);
  apply();
}
