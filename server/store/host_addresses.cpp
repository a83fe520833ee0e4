#include "server/store/host_addresses.h"

#include <arpa/inet.h>
#include <netdb.h>

#include <array>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>
#include <variant>

namespace papilio::server {

std::vector<std::string> system_addresses(const std::string& host) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(host.c_str(), nullptr, &hints, &found); error != 0)
    throw std::runtime_error("the name " + host + " cannot be looked up: " + gai_strerror(error));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
  std::vector<std::string> addresses;
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
    std::array<char, NI_MAXHOST> text{};
    if (getnameinfo(entry->ai_addr, entry->ai_addrlen, text.data(), text.size(), nullptr, 0, NI_NUMERICHOST) == 0)
      addresses.emplace_back(text.data());
  }
  return addresses;
}

std::vector<std::string> host_addresses(const std::string& host, std::chrono::milliseconds limit, Resolver resolver) {
  std::array<unsigned char, sizeof(in6_addr)> binary{};
  if (inet_pton(AF_INET, host.c_str(), binary.data()) == 1 || inet_pton(AF_INET6, host.c_str(), binary.data()) == 1)
    return {host};
  // The reason is passed as text: an exception shared by two threads would be freed by the last of them.
  using Answer = std::variant<std::vector<std::string>, std::string>;
  std::packaged_task<Answer()> task([host, resolver = std::move(resolver)]() -> Answer {
    try {
      return resolver(host);
    } catch (const std::exception& error) {
      return error.what();
    }
  });
  std::future<Answer> answer = task.get_future();
  std::thread(std::move(task)).detach();
  if (answer.wait_for(limit) != std::future_status::ready)
    throw std::runtime_error("the name " + host + " is not looked up in " + std::to_string(limit.count()) + " ms");
  Answer found = answer.get();
  if (const std::string* reason = std::get_if<std::string>(&found)) throw std::runtime_error(*reason);
  return std::get<std::vector<std::string>>(std::move(found));
}

}  // namespace papilio::server
