#include "server/storage/seals.h"

#include <sqlite3.h>

#include "server/files/digest.h"
#include "server/storage/data_folder.h"

namespace penumbra::server::storage {
namespace {

/// Kind, length and bytes, so that no two lists of values read the same.
void append(std::string& text, char kind, std::string_view bytes) {
  text += kind;
  text += std::to_string(bytes.size());
  text += ':';
  text += bytes;
}

char kind_of(int type) {
  switch (type) {
    case SQLITE_INTEGER:
      return 'i';
    case SQLITE_FLOAT:
      return 'f';
    case SQLITE_BLOB:
      return 'b';
    default:
      return 't';
  }
}

std::string_view bytes_of(sqlite3_value* value) {
  const int type = sqlite3_value_type(value);
  const void* data = type == SQLITE_BLOB ? sqlite3_value_blob(value)
                                         : static_cast<const void*>(sqlite3_value_text(value));
  const auto length = static_cast<std::size_t>(sqlite3_value_bytes(value));
  return {static_cast<const char*>(data), data == nullptr ? 0 : length};
}

/// row_seal(table, name, value, name, value, ...)
void row_seal(sqlite3_context* context, int count, sqlite3_value** values) {
  try {
    std::string text;
    append(text, 't', bytes_of(values[0]));
    for (int i = 1; i + 1 < count; i += 2) {
      const int type = sqlite3_value_type(values[i + 1]);
      if (type == SQLITE_NULL) continue;
      append(text, 'n', bytes_of(values[i]));
      append(text, kind_of(type), bytes_of(values[i + 1]));
    }
    const auto& key = *static_cast<const std::string*>(sqlite3_user_data(context));
    const auto seal = keyed_digest(key, text);
    sqlite3_result_text(context, seal.data(), static_cast<int>(seal.size()), SQLITE_TRANSIENT);
  } catch (const std::exception& error) {
    sqlite3_result_error(context, error.what(), -1);
  }
}

/// row_changed(table, row)
void row_changed(sqlite3_context* context, int, sqlite3_value** values) {
  try {
    const auto& changed = *static_cast<const RowChanged*>(sqlite3_user_data(context));
    changed(std::string(bytes_of(values[0])), sqlite3_value_int64(values[1]));
  } catch (const std::exception& error) {
    sqlite3_result_error(context, error.what(), -1);
  }
}

void drop_key(void* key) {
  delete static_cast<std::string*>(key);
}

std::vector<std::string> columns_of(SQLite::Database& connection, const std::string& table) {
  SQLite::Statement query(
      connection, "SELECT name FROM pragma_table_info(?) WHERE name <> 'seal' ORDER BY cid");
  query.bind(1, table);
  std::vector<std::string> names;
  while (query.executeStep()) names.push_back(query.getColumn(0).getString());
  return names;
}

/// Call of row_seal for the row that `prefix` names (empty, "OLD." or "NEW.").
std::string seal_call(const std::string& table, const std::vector<std::string>& columns,
                      const std::string& prefix) {
  std::string call = "row_seal('" + table + "'";
  for (const auto& name : columns) call += ", '" + name + "', " + prefix + "\"" + name + "\"";
  return call + ")";
}

std::string list_of(const std::vector<std::string>& columns) {
  std::string list;
  for (const auto& name : columns) list += (list.empty() ? "\"" : ", \"") + name + "\"";
  return list;
}

}  // namespace

void Seals::add_function(SQLite::Database& connection) const {
  const int state = sqlite3_create_function_v2(
      connection.getHandle(), "row_seal", -1, SQLITE_UTF8 | SQLITE_DETERMINISTIC,
      new std::string(key), row_seal, nullptr, nullptr, drop_key);
  if (state != SQLITE_OK) throw SQLite::Exception(connection.getHandle(), state);
}

std::vector<std::string> Seals::sealed_tables(SQLite::Database& connection) {
  SQLite::Statement query(connection,
                          "SELECT m.name FROM sqlite_master AS m, pragma_table_info(m.name) AS c "
                          "WHERE m.type = 'table' AND c.name = 'seal' ORDER BY m.name");
  std::vector<std::string> names;
  while (query.executeStep()) names.push_back(query.getColumn(0).getString());
  return names;
}

void Seals::add_views(SQLite::Database& connection) {
  for (const auto& table : sealed_tables(connection)) {
    const auto columns = columns_of(connection, table);
    connection.exec("CREATE TEMP VIEW checked_" + table + " AS SELECT rowid AS row, " +
                    list_of(columns) + ", seal, seal IS " + seal_call(table, columns, "") +
                    " AS intact FROM main." + table);
  }
}

void Seals::add_triggers(SQLite::Database& connection, const RowChanged& changed) {
  const int state = sqlite3_create_function_v2(connection.getHandle(), "row_changed", 2,
                                               SQLITE_UTF8, const_cast<RowChanged*>(&changed),
                                               row_changed, nullptr, nullptr, nullptr);
  if (state != SQLITE_OK) throw SQLite::Exception(connection.getHandle(), state);
  for (const auto& table : sealed_tables(connection)) {
    const auto columns = columns_of(connection, table);
    const auto trigger = [&](const std::string& name, const std::string& when,
                             const std::string& body) {
      connection.exec("CREATE TEMP TRIGGER " + table + "_" + name + " " + when + " BEGIN " + body +
                      "; END");
    };
    const auto seal = "UPDATE " + table + " SET seal = " + seal_call(table, columns, "NEW.") +
                      " WHERE rowid = NEW.rowid; SELECT row_changed('" + table + "', NEW.rowid)";
    const auto any = " UPDATE OF " + list_of(columns) + " ON main." + table;
    trigger("inserted", "AFTER INSERT ON main." + table, seal);
    trigger("damaged",
            "BEFORE" + any + " WHEN OLD.seal IS NOT " + seal_call(table, columns, "OLD."),
            "SELECT RAISE(ABORT, '" + damaged_row_message + "')");
    trigger("changed", "AFTER" + any, seal);
    trigger("deleted", "AFTER DELETE ON main." + table,
            "SELECT row_changed('" + table + "', OLD.rowid)");
  }
}

void Seals::seal_all(SQLite::Database& connection) {
  for (const auto& table : sealed_tables(connection))
    connection.exec("UPDATE " + table +
                    " SET seal = " + seal_call(table, columns_of(connection, table), ""));
}

std::string make_seal_key(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) write_file_durably(file, random_bytes(32));
  return read_file(file);
}

}  // namespace penumbra::server::storage
