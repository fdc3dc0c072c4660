#include "server/storage/readers.h"

namespace penumbra::server::storage {

Readers::Readers(Open open_, std::size_t most_) : open(std::move(open_)), most(most_) {}

std::size_t Readers::waiting() const {
  const std::lock_guard lock(mutex);
  return queue.size();
}

/// An idle connection, or none where one may be opened.
std::unique_ptr<Connection> Readers::take() {
  std::unique_lock lock(mutex);
  if (!idle.empty()) {
    auto connection = std::move(idle.back());
    idle.pop_back();
    return connection;
  }
  if (count < most) {
    ++count;
    return nullptr;
  }
  Waiter waiter;
  queue.push_back(&waiter);
  lock.unlock();
  waiter.served.acquire();
  return std::move(waiter.connection);
}

void Readers::give(std::unique_ptr<Connection> connection) {
  const std::lock_guard lock(mutex);
  if (queue.empty()) {
    if (connection)
      idle.push_back(std::move(connection));
    else
      --count;
    return;
  }
  Waiter& next = *queue.front();
  queue.pop_front();
  next.connection = std::move(connection);
  next.served.release();  // last: it may be gone as soon as it knows
}

Readers::Lease::Lease(Readers& owner_) : owner(owner_), connection(owner.take()) {
  if (connection) return;
  try {
    connection = owner.open();
  } catch (...) {
    owner.give(nullptr);
    throw;
  }
}

Readers::Lease::~Lease() {
  owner.give(std::move(connection));
}

}  // namespace penumbra::server::storage
