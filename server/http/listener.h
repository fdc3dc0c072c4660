#pragma once

#include <httplib.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/http/connection.h"
#include "server/http/task_queue.h"

namespace penumbra::server::http {

struct ListenerOptions {
  std::size_t threads = 8;          ///< requests answered at once
  std::size_t connections = 64;     ///< open at once; beyond, the one that waits longest ends
  std::size_t buffered = 64 << 20;  ///< bytes of unfinished requests; beyond, the largest end
  ConnectionLimits limits;
  std::vector<std::string> methods;  ///< known here; others are refused
  /// Counts a request that is refused before a thread reads it, and returns its answer.
  std::function<std::string(const Error&, bool with_body)> refusal;
};

/// Accepts connections, waits on all of them with one thread, and spends others only on requests
/// whose head has come as a whole and was checked. The library takes it from there.
class Listener : public httplib::Server {
 public:
  explicit Listener(ListenerOptions options_);
  ~Listener() override;

  /// Binds without listening yet. Throws Error: conflict (`field`) where it cannot.
  int bind(const std::string& host, int port, const char* field);
  void start();

  /// Accepts nothing new, ends connections that await a request and returns when all that run were
  /// answered.
  void finish();

 private:
  using Clock = Connection::Clock;
  using Owned = std::unique_ptr<Connection>;

  // On the thread that waits.
  void run();
  void accept_some();
  bool make_room();
  void advance(Owned connection);
  void keep(Owned connection);
  Owned take(std::map<int, Owned>::iterator entry);
  void hand_out(Owned connection);
  void refuse(Owned connection, const Error& reason);
  void take_back();
  void end_late_ones();
  void wake() const;

  // On a thread of the queue.
  void answer(Owned connection);
  bool answer_one(Connection& connection);
  Connection::State next_request(Connection& connection);

  ListenerOptions options;
  int poller = -1;
  int waker = -1;
  std::atomic<bool> stopping{false};
  std::atomic<std::size_t> running{0};   ///< connections whose request was handed out
  std::atomic<std::size_t> buffered{0};  ///< bytes of unfinished requests
  std::map<int, Owned> waiting;          ///< by descriptor; the waiting thread's alone
  std::mutex mutex;
  std::vector<Owned> returned;  ///< from threads that answered
  std::unique_ptr<ElasticTaskQueue> queue;
  std::thread thread;
};

}  // namespace penumbra::server::http
