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

let ahead = [];

/// Fetches ahead of time, so that a page opens even where the network is gone by then. Whether that
/// worked is found out when the page is shown.
export function load_ahead(page) {
  ahead = [...(page?.images ?? []), page?.reference].filter(Boolean).map(({ url }) => {
    const image = new Image();
    image.src = url;
    return image;  // held on to, so that the browser keeps it
  });
}
