// Failures and numbers in words.

import { ApiError } from "/assets/shared/http.js";

const hints = {
  0: "The server cannot be reached. Is it running?",
  401: "Access needs the token: open the link that the server printed when it started.",
  403: "This access token is not valid here, or the page was opened under another address than the server's.",
  429: "Too many requests at once. Please wait a moment.",
  503: "The server has no room for more work at the moment. Please try again shortly.",
  504: "The picture took longer than the server allows. Fewer samples or a smaller picture may help.",
};

export function words_of(error) {
  if (!(error instanceof ApiError)) return String(error?.message ?? error);
  const hint = hints[error.status];
  const where = error.field ? ` (${error.field})` : "";
  return hint ? `${hint}${error.status === 0 ? "" : ` ${error.message}${where}`}` : `${error.message}${where}`;
}

const absent = "–";

export const fixed = (value, digits) => (Number.isFinite(value) ? value.toFixed(digits) : absent);
export const significant = (value, digits = 3) => (Number.isFinite(value) ? String(Number(value.toPrecision(digits))) : absent);

export function bytes(value) {
  if (!Number.isFinite(value)) return absent;
  const units = ["B", "KiB", "MiB", "GiB"];
  const power = Math.min(units.length - 1, Math.floor(Math.log2(Math.max(1, Math.abs(value))) / 10));
  return `${significant(value / 2 ** (10 * power))} ${units[power]}`;
}

export function probability(value) {
  if (!Number.isFinite(value)) return absent;
  return value < 0.0001 ? "< 0.0001" : value.toFixed(4);
}
