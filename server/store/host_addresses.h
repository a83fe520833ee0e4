#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace papilio::server {

/// Function that returns the addresses of a host, as text. Throws std::runtime_error with the reason if there are none.
using Resolver = std::function<std::vector<std::string>(const std::string& host)>;

/// Resolves a host by the system (getaddrinfo): /etc/hosts, DNS. The time depends on the name servers.
[[nodiscard]] std::vector<std::string> system_addresses(const std::string& host);

/// Resolves a host by `resolver`, within `limit`; returns `host` itself if it is an address. Throws std::runtime_error
/// with the reason, also beyond the limit: the resolver then continues on its own thread, and its result is dropped.
[[nodiscard]] std::vector<std::string> host_addresses(const std::string& host, std::chrono::milliseconds limit,
                                                      Resolver resolver = system_addresses);

}  // namespace papilio::server
