#pragma once

#include <httplib.h>

#include <initializer_list>
#include <random>
#include <string>
#include <string_view>

#include "tests/soak/tally.h"
#include "tests/soak/world.h"

namespace papilio::soak {

/// One client: its connection, which is kept, and its judgement of what comes over it.
class Client {
 public:
  Client(const World& world, Tally& tally, std::string kind, uint32_t seed);

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] std::mt19937& random() { return random_; }
  /// One of them.
  template <class List>
  const auto& pick(const List& list) {
    return list[random_() % list.size()];
  }

  /// Sends a request; a connection that the server closed while it was idle is opened again.
  httplib::Result ask(const std::string& method, const std::string& path, const httplib::Headers& headers = {},
                      const std::string& body = {});
  /// The same with a form.
  httplib::Result ask(const std::string& path, const httplib::MultipartFormDataItems& form);

  /// Counts the answer; true when there is one of an allowed status, with all that belongs to a refusal if it is one.
  bool expect(const httplib::Result& answer, std::initializer_list<int> allowed);
  /// An answer of status 200 is a mesh; `bytes` is what it must be, empty if that is not known.
  void expect_mesh(const httplib::Result& answer, std::string_view bytes);
  void count(int status, const std::string& code = {}) { tally_.count(kind_, status, code); }
  void count_without_answer() { tally_.count_without_answer(kind_); }
  void time(double seconds) { tally_.time(seconds); }
  void violate(const std::string& what) { tally_.violate(kind_, what); }

 private:
  const World& world_;
  Tally& tally_;
  std::string kind_;
  std::mt19937 random_;
  httplib::Client http_;
};

inline constexpr const char* draco_type = "application/x-draco";
inline const httplib::Headers as_draco{{"Content-Type", draco_type}};

}  // namespace papilio::soak
