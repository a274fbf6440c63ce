// The wall as one first writes it, in JavaScript: K x + B v inside, v = (x − x before)/T.
export function init(counts) {
  return { x: counts * 2.24e-5 };
}

export function step(s, counts) {
  const x = counts * 2.24e-5;
  const v = (x - s.x) / 0.001;
  s.x = x;
  return x > 0 ? Math.min(Math.max(300 * x + 0.05 * v, -16.5), 16.5) : 0;
}
