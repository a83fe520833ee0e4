#include <array>
#include <thread>

#include "tests/soak/kinds.h"
#include "tests/soak/socket.h"

namespace papilio::soak {
namespace {

using namespace std::chrono_literals;

constexpr auto patience = 60s;

std::string post(const std::string& target, const std::string& fields, const std::string& body) {
  return "POST " + target + " HTTP/1.1\r\nHost: here\r\nContent-Type: application/x-draco\r\n" + fields + "\r\n" + body;
}

std::string with_length(const std::string& target, const std::string& body, const std::string& fields = {}) {
  return post(target, fields + "Content-Length: " + std::to_string(body.size()) + "\r\n", body);
}

void pause(Client& client, unsigned most_milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(client.random()() % most_milliseconds));
}

/// Counts the answer. It may be missing if no status is allowed.
void expect_refusal(Client& client, Socket& socket, bool or_none) {
  std::string code;
  const int status = socket.status(patience, &code);
  if (status == 0 && or_none)
    client.count_without_answer();
  else if (status >= 400 && status < 500)
    client.count(status, code);
  else
    client.violate("status " + std::to_string(status) + " " + code + " where a refusal was due");
}

/// Disconnects at any moment: during the head, the body, the computation or the answer.
void leave(Client& client) {
  Socket socket(client.world().port());
  const bool streamed = client.random()() % 2 == 0;
  std::string request =
      with_length("/v1/refine?levels=5", client.world().coarse(), streamed ? "Accept: multipart/mixed\r\n" : "");
  if (client.random()() % 3 == 0) request.resize(client.random()() % request.size());
  socket.send(request);
  pause(client, 400);
  if (client.random()() % 3 == 0) socket.skip(1 + client.random()() % 100'000, 1s);
  if (client.random()() % 2 == 0) socket.reset();
  client.count_without_answer();
}

void send_garbage(Client& client) {
  static const std::array<std::string, 9> garbage{
      "GET\r\n\r\n",
      "GET / HTTP/3.0\r\n\r\n",
      "GET /v1/info HTTP/1.1\r\nHost : here\r\n\r\n",
      "GET /v1/info HTTP/1.1\r\nA: b\r\n folded\r\n\r\n",
      "POST /v1/refine HTTP/1.1\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
      "POST /v1/refine HTTP/1.1\r\nContent-Length: -5\r\n\r\n",
      "POST /v1/refine HTTP/1.1\r\nContent-Type: application/x-draco\r\n\r\n",
      "POST /v1/refine HTTP/1.1\r\nContent-Type: application/x-draco\r\nTransfer-Encoding: chunked\r\n\r\nxyz\r\n",
      "POST /v1/refine HTTP/1.1\r\nContent-Type: multipart/form-data; boundary=a\r\nContent-Length: "
      "9\r\n\r\n--a\r\nAB\r\n"};
  Socket socket(client.world().port());
  const unsigned choice = client.random()() % (garbage.size() + 2);
  std::string bytes;
  if (choice < garbage.size()) {
    bytes = garbage[choice];
  } else if (choice == garbage.size()) {
    bytes = "GET /v1/info HTTP/1.1\r\nA: " + std::string(100'000, 'a') + "\r\n\r\n";
  } else {
    for (unsigned size = client.random()() % 5000; size > 0; --size) bytes += static_cast<char>(client.random()());
  }
  socket.send(bytes);
  socket.finish();
  expect_refusal(client, socket, choice >= garbage.size());
}

/// Sends single bytes, fast enough for the deadlines.
void send_slowly(Client& client) {
  Socket socket(client.world().port());
  const Order& order = client.pick(client.world().small());
  const std::string request = with_length("/v1/refine?" + order.query, *order.mesh);
  const size_t piece = 1 + request.size() / 10;
  for (size_t begin = 0; begin < request.size(); begin += piece) {
    socket.send(std::string_view(request).substr(begin, piece));
    std::this_thread::sleep_for(100ms);
  }
  std::string code;
  const int status = socket.status(patience, &code);
  if (status == 200 || status == 429)
    client.count(status, code);
  else
    client.violate("status " + std::to_string(status) + " for a slow sender");
}

/// Stalls in the middle of a request until the server times out.
void stall(Client& client) {
  Socket socket(client.world().port());
  std::string request = with_length("/v1/refine?levels=1", client.world().coarse());
  request.resize(client.random()() % 2 == 0 ? 30 : request.size() / 2);
  socket.send(request);
  expect_refusal(client, socket, false);
}

void send_too_many_bytes(Client& client) {
  Socket socket(client.world().port());
  const uint64_t most = client.world().max_body_bytes();
  if (client.random()() % 2 == 0) {
    socket.send(post("/v1/refine", "Content-Length: " + std::to_string(most + 1) + "\r\n", ""));
    expect_refusal(client, socket, false);
    return;
  }
  socket.send(post("/v1/refine", "Transfer-Encoding: chunked\r\n", ""));
  const std::string chunk = "10000\r\n" + std::string(0x10000, 'x') + "\r\n";
  bool taken = true;
  for (uint64_t sent = 0; taken && sent <= most; sent += 0x10000) taken = socket.send(chunk);
  expect_refusal(client, socket, !taken);
}

}  // namespace

std::vector<Kind> rude_kinds() {
  return {{"left", 2, leave},
          {"garbage requests", 1, send_garbage},
          {"slow", 2, send_slowly},
          {"stalled", 1, stall},
          {"too many bytes", 1, send_too_many_bytes}};
}

}  // namespace papilio::soak
