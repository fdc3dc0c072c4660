// Who may end a render, and whose turn is next.
#include "tests/jobs/render_service_fixture.h"

namespace penumbra::server {
namespace {

class Submitters : public RenderServiceTest {
 protected:
  /// Waits until the worker draws it.
  void await_begin(const std::string& id) {
    while (service->find(id)->status == "queued") std::this_thread::yield();
  }

  /// Ids in the order in which they were drawn.
  std::vector<std::string> drawn() const {
    std::vector<std::string> ids;
    for (const std::string& line : log("end")) ids.push_back(line.substr(4));
    return ids;
  }
};

Submitter holder(const std::string& key, Priority priority = Priority::anonymous,
                 const std::string& client = "") {
  return {priority, client, {key}, {}};
}

TEST_F(Submitters, cancel_what_nobody_else_waits_for) {
  start();
  const json body = request(64, Behaviour::hangs);
  const std::string id = service->submit(body, holder("a")).id;
  service->submit(body, holder("b"));  // a second person wants it too
  await_begin(id);
  EXPECT_TRUE(service->release(id, {"a"}));
  EXPECT_EQ(service->find(id)->status, "running");
  EXPECT_TRUE(service->release(id, {"b"}));
  EXPECT_EQ(service->wait(id, patience_s)->status, "cancelled");
  EXPECT_FALSE(service->release(std::string(32, '0'), {"a"}));
  EXPECT_EQ(ended(request(65)).status, "done");
}

TEST_F(Submitters, cancel_what_still_waits_without_a_worker) {
  start();
  await_begin(service->submit(request(64, Behaviour::behaves, 300)).id);
  const std::string id = service->submit(request(65), holder("a")).id;
  EXPECT_TRUE(service->release(id, {"a"}));
  EXPECT_EQ(service->find(id)->status, "cancelled");
}

TEST_F(Submitters, cannot_end_what_others_asked_for) {
  start();
  const std::string id = service->submit(request(64, Behaviour::behaves, 300), holder("a")).id;
  const std::string waits = service->submit(request(65), holder("a")).id;
  for (int i = 0; i < 20; ++i)
    for (const std::string& one : {id, waits}) {
      EXPECT_FALSE(service->release(one, {"b"}));
      EXPECT_FALSE(service->release(one, {""}));
    }
  EXPECT_EQ(service->wait(id, patience_s)->status, "done");
  EXPECT_EQ(service->wait(waits, patience_s)->status, "done");
}

TEST_F(Submitters, that_join_what_is_being_cancelled_get_it) {
  start();
  for (int i = 0; i < 20; ++i) {
    const json body = request(64 + i, Behaviour::behaves, 60);
    const std::string id = service->submit(body, holder("a")).id;
    await_begin(id);
    EXPECT_TRUE(service->release(id, {"a"}));
    // The worker is stopped within some 20 ms: before, meanwhile or after.
    std::this_thread::sleep_for(std::chrono::milliseconds(2 * i));
    service->submit(body, holder("b", Priority::publication));
    EXPECT_EQ(service->wait(id, patience_s)->status, "done") << i;
  }
}

TEST_F(Submitters, that_ask_twice_are_one) {
  start();
  const json body = request(64, Behaviour::hangs);
  const std::string id = service->submit(body, holder("a")).id;
  for (int i = 0; i < 5; ++i) service->submit(body, holder("a"));
  EXPECT_TRUE(service->release(id, {"a"}));
  EXPECT_EQ(service->wait(id, patience_s)->status, "cancelled");
}

TEST_F(Submitters, may_be_released_by_those_they_name) {
  start();
  Submitter who = holder("a");
  who.further_keys = {"supervisor"};
  const std::string id = service->submit(request(64, Behaviour::hangs), who).id;
  const std::string other = service->submit(request(65), holder("b")).id;
  EXPECT_FALSE(service->release(other, {"supervisor"}));
  EXPECT_TRUE(service->release(id, {"supervisor"}));
  EXPECT_EQ(service->wait(id, patience_s)->status, "cancelled");
  EXPECT_EQ(service->wait(other, patience_s)->status, "done");
}

TEST_F(Submitters, of_a_publication_come_first_and_of_one_priority_take_turns) {
  start();
  await_begin(service->submit(request(60, Behaviour::behaves, 500)).id);
  const auto ask = [&](int width, Priority priority, const std::string& client) {
    return service->submit(request(width), {priority, client, {"key"}, {}}).id;
  };
  std::vector<std::string> of_a, of_b;
  for (int i = 0; i < 4; ++i) of_a.push_back(ask(100 + i, Priority::anonymous, "a"));
  for (int i = 0; i < 2; ++i) of_b.push_back(ask(200 + i, Priority::anonymous, "b"));
  const std::string researcher = ask(300, Priority::researcher, "");
  const std::string publication = ask(400, Priority::publication, "study");
  // An anonymous picture that a study needs as well is drawn for the study.
  ask(103, Priority::publication, "study");
  for (const std::string& id : of_a) service->wait(id, patience_s);
  for (const std::string& id : of_b) service->wait(id, patience_s);
  const std::vector<std::string> order = drawn();
  EXPECT_THAT(std::vector(order.begin() + 1, order.end()),
              testing::ElementsAre(publication, of_a[3], researcher, of_a[0], of_b[0], of_a[1],
                                   of_b[1], of_a[2]));
}

TEST_F(Submitters, that_fill_the_queue_leave_room_for_those_before_them) {
  options.queue_limit = 3;
  start();
  await_begin(service->submit(request(60, Behaviour::behaves, 300)).id);
  for (int i = 0; i < 3; ++i) service->submit(request(100 + i), holder("a"));
  EXPECT_THROW(service->submit(request(110), holder("a")), Error);
  EXPECT_NO_THROW(service->submit(request(111), holder("r", Priority::researcher)));
  const std::string id = service->submit(request(112), holder("p", Priority::publication)).id;
  EXPECT_EQ(service->statistics().at("queued_anonymous"), 3);
  EXPECT_EQ(service->statistics().at("queued_publication"), 1);
  EXPECT_EQ(service->wait(id, patience_s)->status, "done");
  EXPECT_EQ(drawn().at(1), id);
}

TEST_F(Submitters, share_one_copy_of_a_file) {
  ::setenv("STAND_IN_PADDING", "8000000", 1);
  start();
  const std::string id = ended(request(64)).id;
  std::vector<SharedBytes> copies(20);
  std::vector<std::thread> readers;
  for (SharedBytes& copy : copies)
    readers.emplace_back([&] { copy = service->stored_artefact(id, "image.png"); });
  for (std::thread& reader : readers) reader.join();
  ASSERT_NE(copies.front(), nullptr);
  for (const SharedBytes& copy : copies) EXPECT_EQ(copy, copies.front());
}

}  // namespace
}  // namespace penumbra::server
