// Loading the pictures of a page: all of them decoded, or none shown.

function decoded(url) {
  const image = new Image();
  image.src = url;
  return image.decode().then(() => image);
}

const letter_of = (position) =>
  position < 26 ? String.fromCharCode(65 + position) : letter_of(Math.floor(position / 26) - 1) + letter_of(position % 26);

/// The pictures of a page by slot, in the order shown. A picture's letter follows its place on this
/// page and nothing else. Throws if any cannot be loaded or decoded.
export async function load_pictures(page, strings) {
  const one = async ({ slot, url }, position) => {
    const image = await decoded(url);
    const letter = letter_of(position);
    return [String(slot), { slot: String(slot), url, letter, name: strings.picture(letter),
      width: image.naturalWidth, height: image.naturalHeight }];
  };
  const [pairs] = await Promise.all([
    Promise.all(page.images.map(one)),
    page.reference ? decoded(page.reference.url) : null,
  ]);
  return new Map(pairs);
}

/// Fetches ahead of time; whether that worked is found out when the page is shown.
export function load_ahead(page) {
  for (const { url } of page?.images ?? []) new Image().src = url;
  if (page?.reference) new Image().src = page.reference.url;
}
