#include "server/http/request_id.h"

#include <algorithm>
#include <random>

namespace papilio::server {
namespace {

constexpr size_t longest = 64;

bool is_sane(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '_' || c == '-';
}

}  // namespace

std::string request_id(const std::string& offered) {
  if (!offered.empty() && offered.size() <= longest && std::ranges::all_of(offered, is_sane)) return offered;
  thread_local std::mt19937_64 random{(uint64_t{std::random_device{}()} << 32) | std::random_device{}()};
  constexpr const char* digits = "0123456789abcdef";
  std::string id(16, '0');
  uint64_t bits = random();
  for (char& c : id) {
    c = digits[bits & 15];
    bits >>= 4;
  }
  return id;
}

}  // namespace papilio::server
