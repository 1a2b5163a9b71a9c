// The gallery: a dialog of surfaces with small pictures, which draw themselves while they are looked at.
import { Painter } from "./painter.js";

const SIDE = 80;
/** A small picture gets so many milliseconds; what is known then is shown. */
const TIME = 4000;

export class Gallery {
  #dialog = document.querySelector("#gallery");
  #list = document.querySelector("#exhibits");
  #search = document.querySelector("#search");
  #module;
  #painter = null;
  #waiting = [];
  #current = null;

  /** `choose` is called with the name of a surface. */
  constructor(module, exhibits, choose) {
    this.#module = module;
    for (const exhibit of exhibits) this.#list.append(this.#item(exhibit, choose));
    this.#search.addEventListener("input", () => this.#filter());
    document.querySelector("#close").addEventListener("click", () => this.#dialog.close());
    this.#dialog.addEventListener("click", (event) => event.target === this.#dialog && this.#dialog.close());
    this.#dialog.addEventListener("close", () => this.#rest());
    const seen = new IntersectionObserver((entries) => {
      for (const { target, isIntersecting } of entries) {
        if (isIntersecting) {
          seen.unobserve(target);
          this.#waiting.push(target);
        }
      }
      this.#paint();
    });
    for (const canvas of this.#list.querySelectorAll("canvas")) seen.observe(canvas);
  }

  open() {
    this.#dialog.showModal();
    this.#search.value = "";
    this.#filter();
    this.#paint();
  }

  #item({ name, title, author, year }, choose) {
    const item = document.createElement("li");
    const button = document.createElement("button");
    button.type = "button";
    const canvas = document.createElement("canvas");
    Object.assign(canvas, { width: SIDE, height: SIDE });
    canvas.dataset.name = name;
    canvas.setAttribute("aria-hidden", "true");
    const label = document.createElement("span");
    label.textContent = title;
    const note = document.createElement("small");
    note.textContent = [author?.split(/[;,]/)[0], year].filter(Boolean).join(", ");
    button.append(canvas, label, note);
    button.addEventListener("click", () => {
      this.#dialog.close();
      choose(name);
    });
    item.dataset.words = `${name} ${title} ${author ?? ""} ${year ?? ""}`.toLowerCase();
    item.append(button);
    return item;
  }

  #filter() {
    const words = this.#search.value.toLowerCase().split(/\s+/);
    for (const item of this.#list.children) item.hidden = !words.every((word) => item.dataset.words.includes(word));
  }

  #paint() {
    if (!this.#dialog.open || this.#current || this.#waiting.length === 0) return;
    const handlers = {
      picture: ({ pixels }) => {
        this.#current.getContext("2d").putImageData(new ImageData(pixels, SIDE, SIDE), 0, 0);
        this.#current = null;
        this.#paint();
      },
      failed: () => {
        this.#current = null;
        this.#paint();
      },
    };
    this.#painter ??= new Painter(this.#module, handlers, 1);
    this.#current = this.#waiting.shift();
    this.#painter.draw({ scene: this.#current.dataset.name, width: SIDE, height: SIDE }, "", TIME);
  }

  /** No work for pictures that nobody looks at. */
  #rest() {
    this.#painter?.close();
    this.#painter = null;
    if (this.#current) this.#waiting.unshift(this.#current);
    this.#current = null;
  }
}
