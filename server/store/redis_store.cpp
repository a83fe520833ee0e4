#include "server/store/redis_store.h"

#include <hiredis/hiredis.h>
#include <sys/time.h>

#include <cerrno>
#include <charconv>
#include <stdexcept>

#include "proto/problem.h"
#include "proto/url.h"
#include "server/log.h"
#include "server/sha256.h"
#include "server/store/host_addresses.h"

namespace papilio::server {

using proto::Code;
using proto::Problem;

namespace {

constexpr timeval longest_wait{2, 0};
constexpr std::chrono::seconds away_interval{1};
constexpr size_t most_addresses = 2;             ///< upper bound of the addresses tried for a name
constexpr std::chrono::seconds longest_try{12};  ///< time to look up, connect (twice), authenticate, select and ask

Problem no_answer() {
  return {Code::store_unavailable,
          "The store of meshes does not answer. Try again after the time in Retry-After; "
          "POST /v1/refine works without it."};
}

/// Logs the reason for the operator, and returns the problem for the client.
Problem redis_unavailable(std::string_view reason) {
  log_event("error", "store", {{"kind", "redis"}, {"reason", std::string(reason)}});
  return no_answer();
}

std::string key_of(const std::string& id) { return "papilio:mesh:" + id; }

bool parse_integer(std::string_view text, int most, int& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= 0 && value <= most;
}

bool has_error(const redisReply& reply, std::string_view kind) {
  return reply.type == REDIS_REPLY_ERROR && std::string_view(reply.str, reply.len).starts_with(kind);
}

/// Returns whether the reply answers the command, perhaps by a refusal: errors of the key (WRONGTYPE) and of its value
/// (OOM) do. All other errors concern the server or the connection (READONLY, LOADING, NOAUTH, MOVED, too many
/// clients).
bool is_answer(const redisReply& reply) {
  return reply.type != REDIS_REPLY_ERROR || has_error(reply, "WRONGTYPE") || has_error(reply, "OOM");
}

/// Returns whether the server currently refuses all commands, not only this one.
bool answers_nothing(const redisReply& reply) {
  for (const std::string_view kind : {"LOADING", "NOAUTH", "MASTERDOWN", "CLUSTERDOWN", "BUSY"})
    if (has_error(reply, kind)) return true;
  return false;
}

std::string_view text_of(const redisReply& reply) {
  return reply.str == nullptr ? "an odd answer" : std::string_view(reply.str, reply.len);
}

}  // namespace

std::optional<RedisAddress> parse_redis_address(std::string_view text) {
  constexpr std::string_view unix_scheme = "redis+unix:";
  constexpr std::string_view scheme = "redis://";
  RedisAddress address;
  if (text.starts_with(unix_scheme)) {
    address.path = text.substr(unix_scheme.size());
    return address.path.empty() ? std::nullopt : std::optional(address);
  }
  if (!text.starts_with(scheme)) return std::nullopt;
  text.remove_prefix(scheme.size());
  if (const size_t at = text.rfind('@'); at != std::string_view::npos) {
    const std::string_view secret = text.substr(0, at);
    const size_t colon = secret.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    auto user = proto::decode_url(secret.substr(0, colon));
    auto password = proto::decode_url(secret.substr(colon + 1));
    if (!user || !password) return std::nullopt;
    address.user = *std::move(user);
    address.password = *std::move(password);
    text.remove_prefix(at + 1);
  }
  if (const size_t slash = text.find('/'); slash != std::string_view::npos) {
    if (slash + 1 < text.size() && !parse_integer(text.substr(slash + 1), 1 << 20, address.database))
      return std::nullopt;
    text = text.substr(0, slash);
  }
  if (const size_t colon = text.rfind(':'); colon != std::string_view::npos && !text.ends_with(']')) {
    if (!parse_integer(text.substr(colon + 1), 65535, address.port)) return std::nullopt;
    text = text.substr(0, colon);
  }
  if (text.starts_with('[') && text.ends_with(']')) text = text.substr(1, text.size() - 2);
  address.host = text;
  return address.host.empty() ? std::nullopt : std::optional(address);
}

void RedisStore::ContextDeleter::operator()(redisContext* context) const { redisFree(context); }
void RedisStore::ReplyDeleter::operator()(redisReply* reply) const { freeReplyObject(reply); }

RedisStore::RedisStore(RedisAddress address, uint64_t budget, int seconds)
    : address_(std::move(address)), budget_(budget), seconds_(seconds) {}
RedisStore::~RedisStore() = default;

bool RedisStore::put(const std::string& id, std::string_view bytes) {
  const std::string key = key_of(id);
  const uint64_t there = size_of(key);
  if (there == bytes.size() && get(id) != nullptr) return false;
  if (there > 0) log_event("error", "store", {{"key", key}, {"reason", "the value is damaged; it is replaced"}});
  if (used_memory() + bytes.size() > budget_ + there)
    throw Problem(Code::store_full,
                  "The store of " + std::to_string(budget_) +
                      " bytes has no room for this mesh. Delete meshes, or ask the operator for room.");
  const std::string seconds = std::to_string(seconds_);
  std::vector<std::string_view> words{"SET", key, bytes};  // replaces a damaged value, also of another type
  if (seconds_ > 0) words.insert(words.end(), {"EX", seconds});
  const Reply reply = ask(words);
  if (has_error(*reply, "OOM"))
    throw Problem(Code::store_full, "The store of meshes is full. Delete meshes, or ask the operator for room.");
  if (reply->type != REDIS_REPLY_STATUS) throw redis_unavailable(text_of(*reply));
  return true;
}

uint64_t RedisStore::size_of(const std::string& key) {
  const Reply reply = ask({"STRLEN", key});
  if (has_error(*reply, "WRONGTYPE")) return 0;
  if (reply->type != REDIS_REPLY_INTEGER) throw redis_unavailable(text_of(*reply));
  return static_cast<uint64_t>(reply->integer);
}

bool RedisStore::contains(const std::string& id) {
  const std::string key = key_of(id);
  const std::string seconds = std::to_string(seconds_);
  const Reply reply = seconds_ > 0 ? ask({"EXPIRE", key, seconds}) : ask({"EXISTS", key});
  if (reply->type != REDIS_REPLY_INTEGER) throw redis_unavailable(text_of(*reply));
  return reply->integer > 0;
}

MeshStore::Bytes RedisStore::get(const std::string& id) {
  const std::string key = key_of(id);
  const std::string seconds = std::to_string(seconds_);
  const Reply reply = seconds_ > 0 ? ask({"GETEX", key, "EX", seconds}) : ask({"GET", key});
  if (reply->type == REDIS_REPLY_NIL) return nullptr;
  if (reply->type == REDIS_REPLY_STRING) {
    auto bytes = std::make_shared<const std::string>(reply->str, reply->len);
    if (sha256(*bytes) == id) return bytes;
  } else if (!has_error(*reply, "WRONGTYPE")) {
    throw redis_unavailable(text_of(*reply));
  }
  // The value stays: another server may be replacing it now, and its mesh must not be removed.
  log_event("error", "store", {{"key", key}, {"reason", "the content is not what the key says; send the mesh again"}});
  return nullptr;
}

bool RedisStore::remove(const std::string& id) {
  const Reply reply = ask({"DEL", key_of(id)});
  if (reply->type != REDIS_REPLY_INTEGER) throw redis_unavailable(text_of(*reply));
  return reply->integer > 0;
}

uint64_t RedisStore::used_memory() {
  const Reply reply = ask({"INFO", "memory"});
  constexpr std::string_view field = "\nused_memory:";
  const std::string_view text = reply->type == REDIS_REPLY_STRING ? std::string_view(reply->str, reply->len) : "";
  const size_t at = text.find(field);
  uint64_t bytes = 0;
  if (at == std::string_view::npos) throw redis_unavailable("INFO memory was not answered");
  std::from_chars(text.data() + at + field.size(), text.data() + text.size(), bytes);
  return bytes;
}

Problem RedisStore::away(std::string_view reason) {
  const std::lock_guard lock(mutex_);
  is_away_ = true;
  away_until_ = std::chrono::steady_clock::now() + away_interval;
  idle_.clear();  // they are lost too
  return redis_unavailable(reason);
}

RedisStore::Context RedisStore::reach() {
  if (address_.host.empty()) return Context(redisConnectUnixWithTimeout(address_.path.c_str(), longest_wait));
  Context context;
  try {
    std::vector<std::string> hosts = host_addresses(address_.host, std::chrono::seconds(longest_wait.tv_sec));
    if (hosts.size() > most_addresses) hosts.resize(most_addresses);
    for (const std::string& host : hosts) {
      context.reset(redisConnectWithTimeout(host.c_str(), address_.port, longest_wait));
      if (context != nullptr && context->err == 0) break;
    }
  } catch (const std::runtime_error& error) {
    throw away(error.what());
  }
  return context;
}

RedisStore::Context RedisStore::connect() {
  Context context = reach();
  if (context == nullptr || context->err != 0) throw away(context ? context->errstr : "out of memory");
  redisSetTimeout(context.get(), longest_wait);
  const auto require = [&](const std::vector<std::string_view>& words) {
    const Reply reply = ask_on(*context, words);
    if (reply == nullptr) throw away(context->errstr);
    if (reply->type == REDIS_REPLY_ERROR) throw away({reply->str, reply->len});
  };
  if (!address_.user.empty())
    require({"AUTH", address_.user, address_.password});
  else if (!address_.password.empty())
    require({"AUTH", address_.password});
  if (address_.database != 0) require({"SELECT", std::to_string(address_.database)});
  return context;
}

RedisStore::Reply RedisStore::ask_on(redisContext& context, const std::vector<std::string_view>& words) {
  std::vector<const char*> texts;
  std::vector<size_t> sizes;
  for (const std::string_view word : words) {
    texts.push_back(word.data());
    sizes.push_back(word.size());
  }
  return Reply(
      static_cast<redisReply*>(redisCommandArgv(&context, static_cast<int>(words.size()), texts.data(), sizes.data())));
}

// Returns an idle connection; null if there is none. Throws while Redis is known to be unavailable, or another command
// is checking that.
RedisStore::Context RedisStore::take_idle() {
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (now < away_until_) throw no_answer();
  if (is_away_) away_until_ = now + longest_try;
  if (idle_.empty()) return nullptr;
  Context context = std::move(idle_.back());
  idle_.pop_back();
  return context;
}

RedisStore::Reply RedisStore::ask(const std::vector<std::string_view>& words) {
  Context context = take_idle();
  Reply reply;
  if (context != nullptr) {
    errno = 0;
    reply = ask_on(*context, words);
    // Redis closes idle connections, also on a restart. A silent connection gets the command only once.
    const bool is_closed = reply == nullptr && errno != EAGAIN && errno != EWOULDBLOCK;
    if (is_closed || (reply != nullptr && !is_answer(*reply))) {
      drop_idle();  // they lead to the same server
      context = nullptr;
    }
  }
  if (context == nullptr) {
    context = connect();
    reply = ask_on(*context, words);
  }
  if (reply == nullptr) throw away(context->errstr);
  if (answers_nothing(*reply)) throw away(text_of(*reply));
  const std::lock_guard lock(mutex_);
  is_away_ = false;
  away_until_ = {};
  if (is_answer(*reply)) idle_.push_back(std::move(context));
  return reply;
}

void RedisStore::drop_idle() {
  const std::lock_guard lock(mutex_);
  idle_.clear();
}

}  // namespace papilio::server
