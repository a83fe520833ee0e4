#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace papilio::server {

/// The addresses of a host, as text; throws std::runtime_error with the reason when there are none.
using Resolver = std::function<std::vector<std::string>(const std::string& host)>;

/// The system's resolver (getaddrinfo): /etc/hosts, DNS. It may take as long as the name servers let it.
[[nodiscard]] std::vector<std::string> system_addresses(const std::string& host);

/// What `resolver` says of `host`, within `limit`; `host` itself when it is an address already. Throws
/// std::runtime_error with the reason, also when the limit is over: the question then goes on in a thread of its own,
/// and its answer is dropped.
[[nodiscard]] std::vector<std::string> host_addresses(const std::string& host, std::chrono::milliseconds limit,
                                                      Resolver resolver = system_addresses);

}  // namespace papilio::server
