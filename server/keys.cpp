#include "server/keys.h"

#include <openssl/crypto.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "server/http/head.h"
#include "server/sha256.h"

namespace papilio::server {

using proto::Code;
using proto::Problem;

namespace {

constexpr std::string_view digest_mark = "sha256:";
constexpr std::array<std::string_view, 6> other_digests{"sha1", "sha224", "sha384", "sha512", "md5", "sha3"};
constexpr size_t shortest_key = 16;

[[noreturn]] void refuse(const std::filesystem::path& file, size_t line, const std::string& why) {
  throw std::runtime_error("keys: " + file.string() + ":" + std::to_string(line) + ": " + why);
}

/// Returns whether a secret looks like a digest: it starts, in any case, with "sha256" or "sha-256", or with the name
/// of another algorithm and a colon or an equals sign.
bool is_meant_as_digest(std::string secret) {
  std::erase_if(secret, [](char c) { return c == '-' || c == '_'; });
  if (secret.starts_with("sha256")) return true;
  const std::string_view algorithm = std::string_view(secret).substr(0, secret.find_first_of(":="));
  return algorithm.size() < secret.size() && std::ranges::find(other_digests, algorithm) != other_digests.end();
}

/// Returns the key of `Authorization: Bearer KEY`, "" if there is none.
std::string presented(const Request& request) {
  constexpr std::string_view scheme = "bearer ";
  const std::string value = request.header("Authorization");
  if (!same_ignoring_case(value.substr(0, scheme.size()), scheme)) return {};
  return std::string(trimmed(std::string_view(value).substr(scheme.size())));
}

}  // namespace

Keys::Keys(std::filesystem::path file) : file_(std::move(file)), list_(std::make_shared<const List>(read(file_))) {}

void Keys::reload() {
  auto list = std::make_shared<const List>(read(file_));
  const std::lock_guard lock(mutex_);
  list_ = std::move(list);
}

Keys::List Keys::read(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("keys: " + file.string() + " cannot be read");
  List list;
  std::string line;
  for (size_t number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    Key key;
    std::string secret;
    std::string right;
    std::string more;
    if (!(words >> key.name) || key.name.starts_with('#')) continue;
    words >> secret >> right >> more;
    if (!more.empty() || (!right.empty() && right != "manage"))
      refuse(file, number, "a line is `NAME KEY` or `NAME KEY manage`");
    const std::string lower = lower_case(secret);
    if (is_meant_as_digest(lower)) {
      key.digest = lower.starts_with(digest_mark) ? lower.substr(digest_mark.size()) : "";
      if (!is_sha256(key.digest))
        refuse(file, number, "the digest of a key is written sha256: and 64 hexadecimal digits");
    } else {
      if (secret.size() < shortest_key)
        refuse(file, number, "a key has at least " + std::to_string(shortest_key) + " characters");
      key.digest = sha256(secret);
    }
    key.manages = right == "manage";
    list.push_back(std::move(key));
  }
  if (list.empty()) throw std::runtime_error("keys: " + file.string() + " holds no key");
  return list;
}

std::shared_ptr<const Keys::List> Keys::list() const {
  const std::lock_guard lock(mutex_);
  return list_;
}

size_t Keys::size() const { return list()->size(); }

std::string Keys::authorize(const Request& request, Access access) const {
  if (access == Access::open) return {};
  const std::string key = presented(request);
  if (key.empty())
    throw Problem(Code::unauthorized, "An access key is required. Send it as -H 'Authorization: Bearer KEY'.");
  const std::string digest = sha256(key);
  const std::shared_ptr<const List> keys = list();
  const Key* found = nullptr;
  for (const Key& known : *keys)
    if (CRYPTO_memcmp(known.digest.data(), digest.data(), digest.size()) == 0) found = &known;
  if (found == nullptr) throw Problem(Code::unauthorized, "The access key is unknown. Request one from the operator.");
  if (access == Access::manage && !found->manages)
    throw Problem(Code::forbidden, "The access key lacks the right to manage, which this request requires.");
  return found->name;
}

}  // namespace papilio::server
