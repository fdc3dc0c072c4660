// Calls to the API. Every failure is an ApiError that says whether trying again may help.

export class ApiError extends Error {
  constructor(message, { status = 0, code = "network", field = null, errors = [], retry_after_s = null } = {}) {
    super(message);
    this.status = status;  // 0: no reply arrived
    this.code = code;
    this.field = field;
    this.errors = errors;  // all faults of a document, where there may be several
    this.retry_after_s = retry_after_s;
  }

  /// No reply, a busy server or a proxy's failure passes; anything else is an answer.
  get passing() {
    return this.status === 0 || this.status === 408 || this.status === 429 || this.status >= 500;
  }
}

const reply_deadline_ms = 30_000;

async function failure_of(response) {
  let error = {};
  try {
    error = (await response.json()).error ?? {};
  } catch {
    // A proxy in between returns HTML: the status alone must do.
  }
  const after = Number(response.headers.get("Retry-After"));
  return new ApiError(error.message ?? `${response.status} ${response.statusText}`, {
    status: response.status,
    code: error.code ?? "http",
    field: error.field ?? null,
    errors: error.errors ?? [],
    retry_after_s: Number.isFinite(after) && after > 0 ? after : null,
  });
}

/// Returns the parsed JSON (null for an empty body). Throws ApiError.
/// A Blob goes as it is, anything else as JSON.
export async function call(method, path, body = undefined, { deadline_ms = reply_deadline_ms } = {}) {
  const file = body instanceof Blob;
  let response;
  let text;
  try {
    response = await fetch(path, {
      method,
      headers: body === undefined ? {} : { "Content-Type": file ? body.type || "application/octet-stream" : "application/json" },
      body: body === undefined || file ? body : JSON.stringify(body),
      credentials: "same-origin",
      cache: "no-store",
      signal: AbortSignal.timeout(deadline_ms),
    });
    if (!response.ok) throw await failure_of(response);
    text = await response.text();
  } catch (error) {
    if (error instanceof ApiError) throw error;
    throw new ApiError("The server cannot be reached.");
  }
  if (text === "") return null;
  try {
    return JSON.parse(text);
  } catch {
    throw new ApiError("The reply is not what this page expects.", { status: 502, code: "bad_reply" });
  }
}

export const get = (path, options) => call("GET", path, undefined, options);
export const post = (path, body = {}, options = {}) => call("POST", path, body, options);
export const put = (path, body) => call("PUT", path, body);
export const remove = (path) => call("DELETE", path);

/// 122 random bits as RFC 4122 writes them; pages served over plain HTTP have no randomUUID.
export function uuid() {
  if (typeof crypto.randomUUID === "function") return crypto.randomUUID();
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  bytes[6] = (bytes[6] & 0x0f) | 0x40;
  bytes[8] = (bytes[8] & 0x3f) | 0x80;
  const hex = Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
  return [hex.slice(0, 8), hex.slice(8, 12), hex.slice(12, 16), hex.slice(16, 20), hex.slice(20)].join("-");
}

export const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
