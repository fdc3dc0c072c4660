#include "server/storage/journal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <string_view>

#include "renderer/error.h"
#include "server/files/digest.h"
#include "server/files/durable_file.h"
#include "server/storage/data_folder.h"

namespace penumbra::server::storage {
namespace {

Error failed(const std::string& what) {
  return {"storage", "the journal of answers: " + what};
}

template <class Number>
bool read_number(std::string_view text, Number& number) {
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  return failure == std::errc{} && end == text.data() + text.size();
}

/// The part before the next `mark`, which is taken off `text`.
std::string_view take(std::string_view& text, char mark) {
  const auto at = text.find(mark);
  const auto part = text.substr(0, at);
  text.remove_prefix(at == std::string_view::npos ? text.size() : at + 1);
  return part;
}

}  // namespace

std::string text_of(const RowSeals& rows) {
  std::string text;
  for (const auto& [name, seal] : rows)
    text +=
        name.first + ' ' + std::to_string(name.second) + ' ' + (seal.empty() ? "-" : seal) + ';';
  return text;
}

RowSeals rows_of(const std::string& text) {
  RowSeals rows;
  for (std::string_view rest = text; !rest.empty();) {
    auto entry = take(rest, ';');
    RowName name{std::string(take(entry, ' ')), 0};
    if (!read_number(take(entry, ' '), name.second)) throw failed("a line cannot be read");
    rows[name] = entry == "-" ? "" : std::string(entry);
  }
  return rows;
}

Journal::~Journal() {
  if (descriptor >= 0) ::close(descriptor);
}

std::string Journal::line_of(std::uint64_t commit, const std::string& rows) const {
  const auto content = std::to_string(commit) + '|' + rows + '|';
  return content + keyed_digest(key, content) + '\n';
}

Journal::State Journal::read(std::uint64_t last) const {
  State state;
  const auto text = read_whole(file);
  if (!text) return state;
  state.exists = true;
  state.bytes = text->size();
  for (std::string_view rest = *text; !rest.empty();) {
    const bool whole = rest.find('\n') != std::string_view::npos;
    auto line = take(rest, '\n');
    const auto number = take(line, '|');
    const auto rows = take(line, '|');
    std::uint64_t commit = 0;
    const bool fits = whole && read_number(number, commit) &&
                      line_of(commit, std::string(rows)) == std::string(number) + '|' +
                                                                std::string(rows) + '|' +
                                                                std::string(line) + '\n';
    if (!fits) {
      (rest.empty() ? state.torn : state.damaged) = true;
      continue;
    }
    if (commit > last) break;
    state.commit = commit;
    for (const auto& [name, seal] : rows_of(std::string(rows))) {
      if (seal.empty())
        state.rows.erase(name);
      else
        state.rows[name] = seal;
    }
  }
  return state;
}

void Journal::open() {
  if (descriptor >= 0) return;
  descriptor = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  if (descriptor < 0) throw failed(std::strerror(errno));
}

void Journal::append(std::uint64_t commit, const std::string& rows) {
  open();
  struct stat before {};
  if (::fstat(descriptor, &before) != 0) throw failed(std::strerror(errno));
  const auto line = line_of(commit, rows);
  std::size_t done = 0;
  int why = 0;
  while (done < line.size() && why == 0) {
    const auto count = ::write(descriptor, line.data() + done, line.size() - done);
    if (count < 0 && errno != EINTR) why = errno;
    if (count > 0) done += static_cast<std::size_t>(count);
  }
  if (why == 0 && ::fdatasync(descriptor) != 0) why = errno;
  if (why == 0) return;
  // Without the half line, so that the next append does not follow it.
  if (::ftruncate(descriptor, before.st_size) != 0) throw failed("it cannot be cut back");
  throw failed(std::strerror(why));
}

void Journal::compact(const State& state) {
  write_file_durably(file, line_of(state.commit, text_of(state.rows)));
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

}  // namespace penumbra::server::storage
