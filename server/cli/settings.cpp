// Where options come from: flag, environment, file, default, in this order.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <set>

#include "renderer/error.h"
#include "server/cli/session.h"

extern char** environ;

namespace penumbra::server::cli {
namespace {

constexpr std::string_view variable_prefix = "PENUMBRA_";

/// --light-samples is PENUMBRA_LIGHT_SAMPLES.
std::string variable_of(const std::string& option) {
  std::string name(variable_prefix);
  for (const char c : option)
    name += c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

/// Long names of options that take a value from outside the command line.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames())
      if (name != "help" && name != "version" && name != "json" && name != "config")
        names.push_back(name);
  return names;
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

const CLI::App* find_command(const CLI::App& app, const std::string& name) {
  for (const CLI::App* command : commands_of(app))
    if (command->get_name() == name) return command;
  return nullptr;
}

bool any_command_has(const CLI::App& app, const std::string& option) {
  const auto commands = commands_of(app);
  return std::any_of(commands.begin(), commands.end(), [&](const CLI::App* command) {
    const auto names = option_names(*command);
    return std::find(names.begin(), names.end(), option) != names.end();
  });
}

bool is_given(const std::vector<std::string>& arguments, const std::string& option) {
  const std::string flag = "--" + option;
  return std::any_of(arguments.begin(), arguments.end(), [&](const std::string& argument) {
    return argument == flag || argument.starts_with(flag + "=");
  });
}

/// A misspelt variable would be silently ignored; it is an error instead.
void check_variables(const CLI::App& app) {
  std::set<std::string> known{variable_of("config")};
  for (const CLI::App* command : commands_of(app))
    for (const std::string& name : option_names(*command)) known.insert(variable_of(name));
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view text(*entry);
    if (!text.starts_with(variable_prefix)) continue;
    const std::string name(text.substr(0, text.find('=')));
    if (known.contains(name)) continue;
    std::string list;
    for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
    throw bad_value(name, "unknown environment variable " + name + "; there are " + list);
  }
}

struct FileSettings {
  std::map<std::string, std::vector<std::string>> of_all;
  std::map<std::string, std::map<std::string, std::vector<std::string>>> of_command;
};

FileSettings read_file(const CLI::App& app, const std::string& path) {
  FileSettings settings;
  std::vector<CLI::ConfigItem> items;
  try {
    items = CLI::ConfigTOML().from_file(path);
  } catch (const CLI::Error& error) {
    throw bad_value("config", "--config " + path + ": " + error.what());
  }
  for (const CLI::ConfigItem& item : items) {
    if (item.name == "++" || item.name == "--") continue;  // section marks
    const std::string where = "--config " + path + ": ";
    if (item.parents.size() > 1)
      throw bad_value(item.fullname(), where + item.fullname() + " lies too deep");
    if (item.parents.empty()) {
      if (!any_command_has(app, item.name))
        throw bad_value(item.name, where + "no command has an option \"" + item.name + "\"");
      settings.of_all[item.name] = item.inputs;
      continue;
    }
    const std::string& section = item.parents.front();
    const CLI::App* command = find_command(app, section);
    if (!command) throw bad_value(section, where + "there is no command \"" + section + "\"");
    const auto names = option_names(*command);
    if (std::find(names.begin(), names.end(), item.name) == names.end()) {
      std::string list;
      for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
      throw bad_value(item.fullname(),
                      where + section + " has no option \"" + item.name + "\"; it has " + list);
    }
    settings.of_command[section][item.name] = item.inputs;
  }
  return settings;
}

/// The value of --config, taken out of the arguments.
std::string take_config(std::vector<std::string>& arguments) {
  for (auto it = arguments.begin(); it != arguments.end(); ++it) {
    if (it->starts_with("--config=")) {
      const std::string path = it->substr(std::strlen("--config="));
      arguments.erase(it);
      return path;
    }
    if (*it != "--config") continue;
    if (it + 1 == arguments.end()) throw bad_value("config", "--config: the file is missing");
    const std::string path = *(it + 1);
    arguments.erase(it, it + 2);
    return path;
  }
  const char* variable = std::getenv(variable_of("config").c_str());
  return variable ? variable : "";
}

}  // namespace

std::vector<std::string> complete_arguments(const CLI::App& app,
                                            std::vector<std::string> arguments) {
  check_variables(app);
  const std::string path = take_config(arguments);
  FileSettings file;
  if (!path.empty()) file = read_file(app, path);

  const auto named = std::find_if(arguments.begin(), arguments.end(), [&](const std::string& text) {
    return find_command(app, text) != nullptr;
  });
  if (named == arguments.end()) {
    const auto word = std::find_if(arguments.begin(), arguments.end(),
                                   [](const std::string& text) { return !text.starts_with("-"); });
    if (word == arguments.end()) return arguments;
    std::string list;
    for (const CLI::App* known : commands_of(app))
      list += (list.empty() ? "" : ", ") + known->get_name();
    throw bad_value("command", "there is no command \"" + *word + "\"; there are " + list);
  }
  const CLI::App& command = *find_command(app, *named);
  const auto& section = file.of_command[*named];
  std::vector<std::string> added;
  for (const std::string& option : option_names(command)) {
    if (is_given(arguments, option)) continue;
    if (const char* value = std::getenv(variable_of(option).c_str())) {
      added.push_back("--" + option + "=" + value);
      continue;
    }
    const auto own = section.find(option);
    const auto common = file.of_all.find(option);
    if (own != section.end()) {
      for (const std::string& value : own->second) added.push_back("--" + option + "=" + value);
    } else if (common != file.of_all.end()) {
      for (const std::string& value : common->second) added.push_back("--" + option + "=" + value);
    }
  }
  arguments.insert(named + 1, added.begin(), added.end());
  return arguments;
}

}  // namespace penumbra::server::cli
