#pragma once

#include <httplib.h>

#include <initializer_list>
#include <random>
#include <string>
#include <string_view>

#include "tests/soak/tally.h"
#include "tests/soak/world.h"

namespace papilio::soak {

/// Client with a keep-alive connection, which checks all answers.
class Client {
 public:
  Client(const World& world, Tally& tally, std::string kind, uint32_t seed);

  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] std::mt19937& random() { return random_; }
  /// Returns one of the items at random.
  template <class List>
  const auto& pick(const List& list) {
    return list[random_() % list.size()];
  }

  /// Sends a request. Reconnects if the server closed the idle connection.
  httplib::Result ask(const std::string& method, const std::string& path, const httplib::Headers& headers = {},
                      const std::string& body = {});
  /// Sends a request with a form as its body.
  httplib::Result ask(const std::string& path, const httplib::MultipartFormDataItems& form);

  /// Counts the answer. Returns whether its status is allowed and, if it is a refusal, whether it is complete.
  bool expect(const httplib::Result& answer, std::initializer_list<int> allowed);
  /// Checks that an answer of status 200 is a mesh; `bytes`: the expected body, or empty if it is not known.
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
