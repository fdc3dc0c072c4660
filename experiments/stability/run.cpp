#include "experiments/stability/run.h"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>

#include "experiments/engine/results.h"
#include "experiments/stability/child.h"
#include "experiments/stability/drawing.h"
#include "renderer/error.h"

namespace penumbra::experiments::stability {
namespace {

using Clock = std::chrono::steady_clock;

/// A technique on an axis.
struct Task {
  std::string technique;
  techniques::Resolved resolved;
  Axis axis;
};

/// Tasks that one child works off one after the other.
using Unit = std::vector<Task>;

/// A result that is not there yet.
struct Missing {};

std::string key_of(const std::string& where, const Task& task, double value) {
  return where + " " + request_key(task.resolved, task.axis.trial(value));
}

bool is_wanted(const Options& options, const std::string& axis) {
  return options.axes.empty() ||
         std::find(options.axes.begin(), options.axes.end(), axis) != options.axes.end();
}

void check_axes(const Options& options, const std::vector<techniques::Resolved>& all) {
  for (const std::string& wanted : options.axes) {
    std::string known;
    bool found = false;
    const auto look = [&](const std::vector<Axis>& axes, bool list) {
      for (const Axis& axis : axes) {
        found |= axis.id == wanted;
        if (list) known += (known.empty() ? "" : ", ") + axis.id;
      }
    };
    look(scene_axes(), true);
    for (const techniques::Resolved& technique : all) look(parameter_axes(technique), false);
    if (!found)
      throw not_found("axes", "no axis '" + wanted + "'; there are " + known +
                                  ", and 'NAME up' and 'NAME down' of a technique's parameters");
  }
}

/// One unit for each scene axis, so that its scenes are judged once, and one for the parameters of
/// each technique.
std::vector<Unit> units_of(const Options& options, std::vector<std::string>& ids) {
  ids = options.techniques;
  if (ids.empty())
    for (const TechniqueDescription& technique : techniques::all()) ids.push_back(technique.id);
  std::vector<techniques::Resolved> all;
  for (const std::string& id : ids) all.push_back(techniques::resolve(id));
  check_axes(options, all);
  std::vector<Unit> units;
  for (const Axis& axis : scene_axes()) {
    if (!is_wanted(options, axis.id)) continue;
    Unit unit;
    for (std::size_t i = 0; i < ids.size(); ++i) unit.push_back({ids[i], all[i], axis});
    units.push_back(std::move(unit));
  }
  for (std::size_t i = 0; i < ids.size(); ++i) {
    Unit unit;
    for (Axis& axis : parameter_axes(all[i]))
      if (is_wanted(options, axis.id)) unit.push_back({ids[i], all[i], std::move(axis)});
    if (!unit.empty()) units.push_back(std::move(unit));
  }
  return units;
}

/// The finding of a task from what is known. Throws Missing.
Finding known_finding(const Results& results, const std::string& where, const Task& task) {
  return search(task.technique, task.axis, [&](double value) {
    const nlohmann::json* row = results.find(key_of(where, task, value));
    if (row == nullptr) throw Missing{};
    Step step = step_from_json(*row);
    step.value = value;  // results of one picture may serve several axes
    return step;
  });
}

bool is_known(const Results& results, const std::string& where, const Unit& unit) {
  try {
    for (const Task& task : unit) known_finding(results, where, task);
    return true;
  } catch (const Missing&) {
    return false;
  }
}

/// What a child does: draws what is not known, and tells of every step before and after.
void work_off(const Unit& unit, const Results& known, const std::string& where,
              const RendererOptions& device, const Child::Tell& tell) {
  Drawing drawing(device);
  std::map<std::string, nlohmann::json> own;
  for (const Task& task : unit)
    search(task.technique, task.axis, [&](double value) {
      const Trial trial = task.axis.trial(value);
      const std::string key = where + " " + request_key(task.resolved, trial);
      const nlohmann::json* row = known.find(key);
      if (row == nullptr && own.contains(key)) row = &own.at(key);
      Step step;
      if (row != nullptr) {
        step = step_from_json(*row);
        step.value = value;
        return step;
      }
      tell({{"begin", key},
            {"technique", task.technique},
            {"axis", task.axis.id},
            {"value", value}});
      step = drawing.draw(task.resolved, trial, value);
      nlohmann::json result = to_json(step);
      result["technique"] = task.technique;
      result["axis"] = task.axis.id;
      own[key] = result;
      tell({{"key", key}, {"result", result}});
      return step;
    });
}

/// A child at work, and the step that it is at.
struct Worker {
  Worker(Child made, std::size_t works_off) : child(std::move(made)), unit(works_off) {}

  Child child;
  std::size_t unit;
  nlohmann::json step;
  Clock::time_point since = Clock::now();
  bool hung = false;
};

class Supervisor {
 public:
  Supervisor(const Options& options, Results& results, std::vector<Unit> units)
      : options_(options), results_(results), units_(std::move(units)) {}

  /// Draws all that is missing.
  void run(const std::string& where) {
    where_ = where;
    for (std::size_t i = 0; i < units_.size(); ++i)
      if (is_known(results_, where_, units_[i]))
        ++done_;
      else
        waiting_.push_back(i);
    while (!waiting_.empty() || !workers_.empty()) {
      while (workers_.size() < std::max(1u, options_.processes) && !waiting_.empty()) {
        start(waiting_.front());
        waiting_.pop_front();
      }
      listen();
    }
  }

  const std::vector<Unit>& units() const { return units_; }
  std::size_t drawn() const { return drawn_; }

 private:
  void start(std::size_t unit) {
    const RendererOptions device{.device = options_.device};
    Child child([&, unit](const Child::Tell& tell) {
      work_off(units_[unit], results_, where_, device, tell);
    });
    workers_.push_back(std::make_unique<Worker>(std::move(child), unit));
  }

  void listen() {
    std::vector<pollfd> descriptors;
    for (const auto& worker : workers_)
      descriptors.push_back({worker->child.descriptor(), POLLIN, 0});
    ::poll(descriptors.data(), descriptors.size(), 500);
    for (std::size_t i = descriptors.size(); i-- > 0;) {
      Worker& worker = *workers_[i];
      const std::chrono::duration<double> silent = Clock::now() - worker.since;
      if (silent.count() > options_.longest_step_s && !worker.hung) {
        worker.hung = true;
        worker.child.kill();
      }
      if (descriptors[i].revents == 0) continue;
      if (worker.child.read([&](const nlohmann::json& line) { hear(worker, line); })) continue;
      end(worker);
      workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  void hear(Worker& worker, const nlohmann::json& line) {
    worker.since = Clock::now();
    if (line.contains("begin")) {
      worker.step = line;
      return;
    }
    results_.add(line.at("key"), line.at("result"));
    worker.step = nullptr;
    ++drawn_;
    if (options_.progress)
      options_.progress(static_cast<double>(done_) / static_cast<double>(units_.size()),
                        line.at("result").at("technique").get<std::string>() + ", " +
                            line.at("result").at("axis").get<std::string>());
  }

  /// A child that died at a step leaves that as the step's result, and another goes on behind it.
  void end(Worker& worker) {
    if (worker.child.death().empty() && !worker.hung) {
      ++done_;
      return;
    }
    if (!worker.step.is_object())
      throw device_error("a process that draws died before its first picture: " +
                         worker.child.death());
    Step step;
    step.value = worker.step.at("value");
    step.state = worker.hung ? State::hung : State::crashed;
    step.message =
        worker.hung
            ? "ended after " + std::to_string(static_cast<int>(options_.longest_step_s)) + " s"
            : worker.child.death();
    nlohmann::json result = to_json(step);
    result["technique"] = worker.step.at("technique");
    result["axis"] = worker.step.at("axis");
    results_.add(worker.step.at("begin"), result);
    ++drawn_;
    waiting_.push_front(worker.unit);
  }

  const Options& options_;
  Results& results_;
  std::vector<Unit> units_;
  std::string where_;
  std::deque<std::size_t> waiting_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::size_t done_ = 0;  ///< units
  std::size_t drawn_ = 0;
};

/// Asks a child, since no device may be made in this process.
DeviceInfo device_of(const std::string& name) {
  Child child([&](const Child::Tell& tell) {
    try {
      const Renderer renderer({.device = name});
      tell({{"name", renderer.device().name}, {"driver", renderer.device().driver}});
    } catch (const Error& error) {
      tell({{"code", error.code}, {"message", error.what()}, {"field", error.field}});
    }
  });
  nlohmann::json heard;
  while (child.read([&](const nlohmann::json& line) { heard = line; })) continue;
  if (heard.contains("code"))
    throw Error(heard.at("code"), heard.at("message").get<std::string>(), heard.at("field"));
  if (!heard.contains("name")) throw device_error("no device: " + child.death());
  DeviceInfo info;
  info.name = heard.at("name");
  info.driver = heard.at("driver");
  return info;
}

}  // namespace

Report run(const Options& options) {
  Report report;
  std::vector<Unit> units = units_of(options, report.techniques);
  std::error_code failed;
  std::filesystem::create_directories(options.out, failed);
  Results results(options.out / "results.jsonl");
  const DeviceInfo device = device_of(options.device);
  report.device = device.name;
  report.driver = device.driver;
  report.version = options.version;
  const std::string where = device.name + " " + device.driver + " " + options.version;
  Supervisor supervisor(options, results, std::move(units));
  supervisor.run(where);
  report.drawn = supervisor.drawn();
  for (const std::string& technique : report.techniques)
    for (const Unit& unit : supervisor.units())
      for (const Task& task : unit) {
        if (task.technique != technique) continue;
        report.findings.push_back(known_finding(results, where, task));
        report.steps += report.findings.back().steps.size();
      }
  return report;
}

}  // namespace penumbra::experiments::stability
