// Loading the pictures of a page: all of them decoded, or none shown.

import { sleep } from "/assets/shared/http.js";

const waits_ms = [500, 1000, 2000, 4000, 8000];

/// True where the server was busy and may soon not be. Without a connection the person decides.
async function worth_another_try(url) {
  try {
    const { ok, status } = await fetch(url);
    return ok || status === 429 || status >= 500;
  } catch {
    return false;
  }
}

/// The picture, asked for again where the server was busy. A whole room may open a page at once.
async function decoded(url) {
  for (let attempt = 0; ; ++attempt) {
    const image = new Image();
    image.src = url;
    try {
      await image.decode();
      return image;
    } catch (error) {
      if (attempt === waits_ms.length || !(await worth_another_try(url))) throw error;
    }
    await sleep(waits_ms[attempt] * (0.5 + Math.random()));
  }
}

const letter_of = (position) =>
  position < 26 ? String.fromCharCode(65 + position) : letter_of(Math.floor(position / 26) - 1) + letter_of(position % 26);

const pictures_of = (page) => [...(page?.images ?? []), page?.reference].filter(Boolean);

/// Addresses of all views of a picture.
const views_of = ({ url, frames }) => frames ?? [url];

/// The pictures of a page by slot, in the order shown. A picture's letter follows its place on this
/// page and nothing else. `progress(done, total)` is told after each picture. Throws if any cannot be
/// loaded or decoded.
export async function load_pictures(page, strings, progress) {
  const total = pictures_of(page).flatMap(views_of).length;
  let done = 0;
  const counted = async (url) => {
    const image = await decoded(url);
    progress(++done, total);
    return image;
  };
  progress(0, total);
  const one = async ({ slot, url, frames }, position) => {
    // Held on to, so that the browser keeps every view.
    const views = await Promise.all(views_of({ url, frames }).map(counted));
    const letter = letter_of(position);
    return [String(slot), { slot: String(slot), url, frames, views, letter, name: strings.picture(letter),
      width: views[0].naturalWidth, height: views[0].naturalHeight }];
  };
  const [pairs] = await Promise.all([
    Promise.all(page.images.map(one)),
    page.reference ? Promise.all(views_of(page.reference).map(counted)).then((views) => (page.reference.views = views)) : null,
  ]);
  return new Map(pairs);
}

const ahead = [];  // held on to, so that the browser keeps them

/// Fetches ahead of time, so that a page opens even where the network is gone by then. Whether that
/// worked is found out when the page is shown.
export function load_ahead(page) {
  ahead.splice(0, ahead.length, ...pictures_of(page).flatMap(views_of).map((url) => {
    const image = new Image();
    image.src = url;
    return image;
  }));
}
