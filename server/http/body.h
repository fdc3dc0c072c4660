#pragma once

#include <httplib.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "renderer/error.h"

namespace penumbra::server::http {

/// What is wrong with how the body is announced, if anything: both lengths and chunks, lengths that
/// are no number, unknown encodings, a body where none belongs.
std::optional<Error> framing_error(const httplib::Request& request, bool bodiless);

/// True where a body follows the headers.
bool has_body(const httplib::Request& request);

/// The body of one request, which can be read once.
class IncomingBody {
 public:
  /// `reader_` is null for methods without a body.
  IncomingBody(const httplib::Request& request_, const httplib::ContentReader* reader_)
      : request(request_), reader(reader_) {}

  /// Reads and decompresses it. Throws too_large beyond `limit` bytes, counted after decompression,
  /// and bad_value where it cannot be read.
  std::string read(std::size_t limit);

  /// Reads what was not read, within reason. False where bytes are left, so that the connection can
  /// take no further request.
  bool finish();

 private:
  /// Hands on up to `limit` bytes and drops some more; counts them all. False where it gave up.
  bool receive(std::size_t limit, std::string* into);

  const httplib::Request& request;
  const httplib::ContentReader* reader;
  bool begun = false;
  bool whole = false;
  std::size_t size = 0;
};

/// Throws bad_value where path or query are no UTF-8 or hold NUL.
void check_text(const httplib::Request& request);

/// Parses JSON of at most 64 levels. Throws bad_value (field body).
nlohmann::json parse_json(const std::string& text);

/// Throws bad_value for anything but an object, and for keys that are not in `known`.
void check_keys(const nlohmann::json& object, std::initializer_list<const char*> known);

/// A number of the query, `otherwise` where it is absent. Throws bad_value naming the field.
double number_in_query(const httplib::Request& request, const std::string& name, double low,
                       double high, double otherwise);

}  // namespace penumbra::server::http
