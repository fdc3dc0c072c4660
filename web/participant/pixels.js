// Pictures on whole device pixels, whatever part of one a CSS pixel is.

const longest_side = 4096;  // CSS pixels

/// A length that is whole in CSS pixels and in device pixels: 10 at a ratio of 1.1, 8 at 2.625.
function whole_length(ratio) {
  let length = 1;
  while (length < longest_side && Math.abs(length * ratio - Math.round(length * ratio)) > 1e-4) ++length;
  return length;
}

/// Shows an image in the middle of `stage` with `scale` (a whole number) device pixels per picture
/// pixel. Browsers round the box of an image to whole pixels, of CSS or of the device, before they draw
/// it, so that a box of 101 / 1.1 CSS pixels drops or doubles a column. A transform is not rounded:
/// the box gets a length that rounding leaves alone, and the transform brings it to size and place.
export function fit_to_device_pixels(image, stage, picture, scale) {
  const ratio = devicePixelRatio;
  const side = whole_length(ratio);
  const size = [picture.width * scale, picture.height * scale];
  const { left, top } = stage.getBoundingClientRect();
  const start = [left + stage.clientLeft, top + stage.clientTop];
  const room = [stage.clientWidth, stage.clientHeight];
  const shifts = size.map((length, axis) => {
    const free = Math.max(0, room[axis] * ratio - length) / 2;
    return `${Math.round(start[axis] * ratio + free) / ratio - start[axis]}px`;
  });
  const scales = size.map((length) => length / (side * ratio));
  Object.assign(image.style, { inlineSize: `${side}px`, blockSize: `${side}px`,
    transform: `translate(${shifts.join(", ")}) scale(${scales.join(", ")})` });
}
