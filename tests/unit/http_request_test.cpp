#include "tests/support/http_fixture.h"

// Ordinary requests and malformed heads.

namespace papilio::server {
namespace {

// Ordinary requests

TEST_F(HttpServerTest, AnswersHaveLengthDateAndId) {
  start();
  Client client(port_);
  const Reply reply = client.ask(get("/hello"));
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.body, "hello GET");
  EXPECT_EQ(reply.field("Content-Length"), "9");
  EXPECT_EQ(reply.field("Content-Type"), "text/plain");
  EXPECT_EQ(reply.field("X-Request-Id").size(), 16u);
  EXPECT_TRUE(reply.field("Date").ends_with(" GMT"));
  EXPECT_EQ(reply.field("Connection"), "");
}

TEST_F(HttpServerTest, AnswersAreNotCompressed) {
  start();
  const Reply reply = ask(get("/hello", "Accept-Encoding: gzip, br\r\n"));
  EXPECT_EQ(reply.body, "hello GET");
  EXPECT_EQ(reply.field("Content-Encoding"), "");
}

TEST_F(HttpServerTest, HeadEqualsGetWithoutABody) {
  start();
  Client client(port_);
  const Reply head = client.ask(request("HEAD /hello"), true);
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.field("Content-Length"), "10");
  EXPECT_EQ(client.ask(request("HEAD /stream"), true).field("Transfer-Encoding"), "chunked");
  EXPECT_EQ(client.ask(request("HEAD /nowhere"), true).status, 404);
  EXPECT_EQ(client.ask(get("/hello")).body, "hello GET") << "HEAD's answers must have had no body";
}

TEST_F(HttpServerTest, NotModifiedHasNeitherBodyNorLength) {
  start();
  Client client(port_);
  const Reply reply = client.ask(get("/unmodified"));
  EXPECT_EQ(reply.status, 304);
  EXPECT_EQ(reply.field("Content-Length"), "");
  EXPECT_EQ(client.ask(get("/hello")).status, 200);
}

TEST_F(HttpServerTest, UnknownPathsAre404ForAnyMethod) {
  start();
  for (const char* method : {"GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS", "TRACE", "PURGE"}) {
    Client client(port_);
    expect_problem(client.ask(request(std::string(method) + " /nowhere")), 404, "not_found");
    EXPECT_EQ(client.ask(get("/hello")).status, 200) << "nothing is unread: the connection is kept";
  }
  expect_problem(ask(get("/hello/")), 404, "not_found");
  expect_problem(ask(get("/hello%2e")), 404, "not_found");
}

TEST_F(HttpServerTest, OtherMethodsAre405WithAllow) {
  start();
  for (const char* method : {"POST", "PUT", "PATCH", "DELETE", "TRACE", "get"}) {
    const Reply reply = ask(request(std::string(method) + " /hello"));
    expect_problem(reply, 405, "method_not_allowed");
    EXPECT_EQ(reply.field("Allow"), "GET, HEAD, OPTIONS");
  }
  EXPECT_EQ(ask(get("/echo")).field("Allow"), "OPTIONS, POST");
}

TEST_F(HttpServerTest, OptionsListsTheMethods) {
  start();
  const Reply reply = ask(request("OPTIONS /hello"));
  EXPECT_EQ(reply.status, 204);
  EXPECT_EQ(reply.field("Allow"), "GET, HEAD, OPTIONS");
}

TEST_F(HttpServerTest, QueryKeepsOrderDuplicatesAndEqualsSigns) {
  start();
  EXPECT_EQ(ask(get("/query?b=2&a=1&a=1&c=x=y&d&e=%2C+?&&=z")).body, "b=2;a=1;a=1;c=x=y;d=;e=, ?;=z;");
  EXPECT_EQ(ask(get("/hell%6F")).body, "hello GET");
}

TEST_F(HttpServerTest, AbsoluteTargetsHaveTheirOwnPathOrTheRoot) {
  start();
  for (const char* origin : {"http://test:80", "HTTP://test", "https://127.0.0.1:", "http://[::1]:8080", "http://%41"})
    EXPECT_EQ(ask(get(std::string(origin) + "/query?a=1")).body, "a=1;") << origin;
  // The path is empty: slashes in the query do not count. The root has no route here.
  for (const char* target :
       {"http://test?x/hello", "http://test", "http://test?/hello", "http://test:80?a=http://x/hello"})
    expect_problem(ask(get(target)), 404, "not_found");
}

TEST_F(HttpServerTest, AuthoritiesThatAreNotValidAreRefused) {
  start();
  for (const char* authority : {"", ":80", "user@test", "user:word@test", "te st", "test:8o", "test:80:80", "[::1",
                                "[]", "[::1]x", "[g::1]", "a[b]", "te\"st", "test\\", "te#st"})
    expect_refused(get("http://" + std::string(authority) + "/hello"), 400, "bad_request");
  for (const char* host : {"a b", "user@test", "te/st", "test:x", "[::1", "a,b@c"})
    expect_refused("GET /hello HTTP/1.1\r\nHost: " + std::string(host) + "\r\n\r\n", 400, "bad_request");
  for (const char* host : {"", "test:8080", "[::1]:80", "a_b.example"})
    EXPECT_EQ(ask("GET /hello HTTP/1.1\r\nHost: " + std::string(host) + "\r\n\r\n").status, 200) << host;
}

TEST_F(HttpServerTest, HeaderValuesAreNotPercentDecoded) {
  start();
  EXPECT_EQ(ask(get("/mirror", "X-In: %0d%0aX: \xc3\xa4 %41\r\n")).body, "%0d%0aX: \xc3\xa4 %41");
}

TEST_F(HttpServerTest, ConnectionServesItsLimitOfRequests) {
  options_.keep_alive_requests = 300;
  start();
  Client client(port_);
  for (int i = 1; i < 300; ++i) {
    const std::string body = "body " + std::to_string(i);
    const Reply reply = client.ask(i % 2 ? post("/echo", body) : get("/query?" + std::to_string(i)));
    ASSERT_EQ(reply.status, 200) << i;
    ASSERT_EQ(reply.field("Connection"), "") << i;
  }
  EXPECT_EQ(client.ask(get("/hello")).field("Connection"), "close");
  EXPECT_TRUE(client.at_end());
}

TEST_F(HttpServerTest, PipelinedRequestsAreAnsweredInOrder) {
  start();
  Client client(port_);
  client.send(post("/echo", "first") + "\r\n" + get("/query?second=") + post("/echo", "third"));
  EXPECT_EQ(client.receive().body, "first");
  EXPECT_EQ(client.receive().body, "second=;");
  EXPECT_EQ(client.receive().body, "third");
}

TEST_F(HttpServerTest, ConnectionClosesOnTheClientsRequest) {
  start();
  for (const std::string& bytes : {get("/hello", "Connection: Close\r\n"), get("/hello", "Connection: x, close\r\n"),
                                   std::string("GET /hello HTTP/1.0\r\n\r\n")}) {
    Client client(port_);
    const Reply reply = client.ask(bytes);
    EXPECT_EQ(reply.body, "hello GET");
    EXPECT_EQ(reply.field("Connection"), "close");
    EXPECT_TRUE(client.at_end());
  }
}

TEST_F(HttpServerTest, FiftyConcurrentConnectionsAreServed) {
  start();
  std::vector<std::thread> clients;
  std::atomic<int> good = 0;
  for (int i = 0; i < 50; ++i) {
    clients.emplace_back([&, i] {
      const std::string body = "body " + std::to_string(i);
      for (int j = 0; j < 5; ++j)
        if (ask(post("/echo", body)).body == body) ++good;
    });
  }
  for (std::thread& client : clients) client.join();
  EXPECT_EQ(good, 250);
  EXPECT_EQ(finished(250).size(), 250u);
}

TEST_F(HttpServerTest, EachRequestIsLoggedOnce) {
  start();
  Client client(port_);
  client.ask(post("/echo?secret=1", "12345", "X-Request-Id: mine\r\n"));
  const Reply odd = client.ask(get("/odd%0Apath"));
  const auto log = finished(2);
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[0].id, "mine");
  EXPECT_EQ(log[0].method, "POST");
  EXPECT_EQ(log[0].path, "/echo");
  EXPECT_EQ(log[0].remote_address, "127.0.0.1");
  EXPECT_EQ(log[0].status, 200);
  EXPECT_EQ(log[0].code, "");
  EXPECT_EQ(log[0].bytes_in, post("/echo?secret=1", "12345", "X-Request-Id: mine\r\n").size());
  EXPECT_GT(log[0].bytes_out, 5u);
  EXPECT_EQ(log[1].status, 400);
  EXPECT_EQ(log[1].code, "bad_request");
  EXPECT_EQ(log[1].bytes_out, odd.head.size() + odd.body.size());
}

// Heads

TEST_F(HttpServerTest, AmbiguousFramingIsRefused) {
  start();
  for (const char* fields : {
           "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n",
           "Transfer-Encoding: chunked\r\nContent-Length: 5\r\n",
           "Content-Length: 5\r\nContent-Length: 5\r\n",
           "Content-Length: 5\r\ncontent-length: 6\r\n",
           "Content-Length: 5, 5\r\n",
           "Content-Length: -5\r\n",
           "Content-Length: +5\r\n",
           "Content-Length: 0x5\r\n",
           "Content-Length: 5 5\r\n",
           "Content-Length: %35\r\n",
           "Content-Length:\r\n",
           "Content-Length : 5\r\n",
           "Content-Length: 5\n\r\n",
           "Content-Length: 5\rX: y\r\n",
           "X: y\r\n Content-Length: 5\r\n",
           "Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n",
           "Transfer-Encoding: gzip, chunked\r\n",
           "Transfer-Encoding: identity\r\n",
           "Transfer-Encoding: %63hunked\r\n",
           "Transfer-Encoding:\r\n",
           "Transfer-Encoding: \x0b"
           "chunked\r\n",
       }) {
    expect_refused(request("POST /echo", fields, "0\r\n\r\n" + smuggled), 400, "bad_request");
  }
  expect_refused("POST /echo HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400, "bad_request");
}

TEST_F(HttpServerTest, GarbageIsRefused) {
  start();
  const std::string host = "Host: test\r\n\r\n";
  for (const std::string& bytes : {"nonsense\r\n" + host,
                                   "GET /hello\r\n" + host,
                                   "GET /hello HTTP/2.0\r\n" + host,
                                   "GET /hello HTTP/1.2\r\n" + host,
                                   "GET /hello http/1.1\r\n" + host,
                                   "GET  /hello HTTP/1.1\r\n" + host,
                                   "GET /hello HTTP/1.1 \r\n" + host,
                                   " GET /hello HTTP/1.1\r\n" + host,
                                   "GET hello HTTP/1.1\r\n" + host,
                                   "GET /h\tello HTTP/1.1\r\n" + host,
                                   "GET /hell\xc3\xb6 HTTP/1.1\r\n" + host,
                                   "G@T /hello HTTP/1.1\r\n" + host,
                                   "GET /% HTTP/1.1\r\n" + host,
                                   "GET /%4 HTTP/1.1\r\n" + host,
                                   "GET /%zz HTTP/1.1\r\n" + host,
                                   "GET /%00 HTTP/1.1\r\n" + host,
                                   "GET /%0d%0aX:y HTTP/1.1\r\n" + host,
                                   "GET /query?a=%g1 HTTP/1.1\r\n" + host,
                                   get("/hello", "no colon\r\n"),
                                   get("/hello", ": no name\r\n"),
                                   get("/hello", "bad name: x\r\n"),
                                   get("/hello", std::string("X: \0\r\n", 6)),
                                   get("/hello", "Host: second\r\n"),
                                   std::string("GET /hello HTTP/1.1\r\n\r\n"),
                                   std::string("GET /hello HTTP/1.1\nHost: test\n\n"),
                                   std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"),
                                   std::string("\x16\x03\x01\x02\n\x01\xfc\x03\x03", 9),
                                   std::string("\r\n\r\n\r\n"),
                                   std::string("\n")}) {
    expect_refused(bytes, 400, "bad_request");
  }
}

TEST_F(HttpServerTest, HeaderFloodIsRefused) {
  start();
  expect_refused(get("/hello", "X: " + std::string(2048, 'x') + "\r\n"), 431, "headers_too_large");
  expect_refused("GET /" + std::string(2100, 'x'), 431, "headers_too_large");
  std::string many;
  for (int i = 0; i < 500; ++i) many += "X-" + std::to_string(i) + ": y\r\n";
  expect_refused(get("/hello", many), 431, "headers_too_large");
  const std::string fitting(2048 - get("/hello", "X: \r\n").size(), 'x');
  EXPECT_EQ(ask(get("/hello", "X: " + fitting + "\r\n")).status, 200);
  expect_refused(get("/hello", "X: " + fitting + "x\r\n"), 431, "headers_too_large");
}

TEST_F(HttpServerTest, SlowHeadIsCut) {
  options_.read_seconds = 1;
  start();
  Client client(port_);
  client.send("GET /hello HTTP/1.1\r\n");
  std::atomic<bool> done = false;
  std::thread dripping([&] {
    while (!done && client.send("X: y\r\n")) std::this_thread::sleep_for(50ms);
  });
  expect_problem(client.receive(), 408, "request_timeout");
  EXPECT_TRUE(client.at_end());
  done = true;
  dripping.join();
}

TEST_F(HttpServerTest, SlowBodyIsCut) {
  options_.read_seconds = 1;
  start();
  for (const bool drips : {false, true}) {
    Client client(port_);
    client.send(request("POST /echo", "Content-Length: 4000\r\n"));
    std::atomic<bool> done = !drips;
    std::thread dripping([&] {
      while (!done && client.send("x")) std::this_thread::sleep_for(20ms);
    });
    expect_problem(client.receive(), 408, "request_timeout");
    EXPECT_TRUE(client.at_end());
    done = true;
    dripping.join();
  }
}

TEST_F(HttpServerTest, IdleConnectionIsClosed) {
  options_.idle_seconds = 1;
  start();
  Client silent(port_);
  Client idle(port_);
  EXPECT_EQ(idle.ask(get("/hello")).status, 200);
  EXPECT_TRUE(idle.at_end());
  EXPECT_TRUE(silent.at_end());
  EXPECT_EQ(finished(1).size(), 1u) << "an idle connection is no request";
}

TEST_F(HttpServerTest, SilentConnectionsHoldNoThread) {
  options_.threads = 1;
  options_.idle_seconds = 600;
  options_.read_seconds = 600;
  start();
  Client silent(port_);
  Client half(port_);
  half.send("GET /hello HTTP/1.1\r\nHo");
  Client idle(port_);
  EXPECT_EQ(idle.ask(get("/hello")).status, 200);
  EXPECT_EQ(ask(get("/hello")).status, 200);
  EXPECT_EQ(idle.ask(get("/hello")).status, 200);
  EXPECT_EQ(silent.ask(get("/hello")).status, 200);
  EXPECT_EQ(half.ask("st: test\r\n\r\n").status, 200);
}

TEST_F(HttpServerTest, BusyConnectionDoesNotStarveOthers) {
  options_.threads = 1;
  start();
  std::atomic<bool> done = false;
  std::thread busy([&] {
    Client client(port_);
    std::string many;
    for (int i = 0; i < 100; ++i) many += get("/hello");
    while (!done && client.send(many))
      for (int i = 0; i < 100; ++i) client.receive();
  });
  for (int i = 0; i < 20; ++i) EXPECT_EQ(ask(get("/hello")).status, 200);
  done = true;
  busy.join();
}

TEST_F(HttpServerTest, RemoteAddressCannotBeForged) {
  start();
  EXPECT_EQ(ask(get("/address")).body, "127.0.0.1 ");
  EXPECT_EQ(ask(get("/address", "REMOTE_ADDR: 6.6.6.6\r\nX-Forwarded-For: 6.6.6.6\r\n")).body, "127.0.0.1 6.6.6.6");
}

TEST_F(HttpServerTest, OnlyTrustedProxiesNameTheClient) {
  start();
  const std::string forwarded = "X-Forwarded-For: 6.6.6.6, 10.0.0.7\r\n";
  EXPECT_EQ(ask(get("/client", forwarded)).body, "127.0.0.1");
  stop();
  options_.trusted_proxies = {"10.0.0.1", "127.0.0.1"};
  start();
  EXPECT_EQ(ask(get("/client", forwarded)).body, "10.0.0.7") << "the first address is forged";
  EXPECT_EQ(ask(get("/client")).body, "127.0.0.1");
  stop();
  options_.authorize = [](const Request&, Access) { return std::string("the key's name"); };
  start();
  EXPECT_EQ(ask(get("/client", forwarded)).body, "the key's name");
}

TEST_F(HttpServerTest, OnlyValidRequestIdsAreKept) {
  start();
  const std::string longest(64, 'a');
  for (const std::string& sane : {std::string("a"), std::string("Az09._-"), longest}) {
    const Reply reply = ask(get("/nowhere", "X-Request-Id: " + sane + "\r\n"));
    EXPECT_EQ(reply.field("X-Request-Id"), sane);
    EXPECT_EQ(nlohmann::json::parse(reply.body).value("request_id", ""), sane);
  }
  std::vector<std::string> ids;
  for (const std::string& insane : {std::string(), longest + "a", std::string("a b"), std::string("a\"b"),
                                    std::string("%0d%0aX: y"), std::string("\xc3\xa4")}) {
    const Reply reply = ask(get("/hello", "X-Request-Id: " + insane + "\r\n"));
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.field("X-Request-Id").size(), 16u);
    EXPECT_EQ(reply.field("X-Request-Id").find_first_not_of("0123456789abcdef"), std::string::npos);
    ids.push_back(reply.field("X-Request-Id"));
  }
  std::sort(ids.begin(), ids.end());
  EXPECT_EQ(std::unique(ids.begin(), ids.end()), ids.end());
}

TEST_F(HttpServerTest, ClientDataCannotAddHeaderLines) {
  start();
  const Reply reply = ask(get("/mirror?X-Out=a%0d%0aX-Evil:%20b%0a&X-Bad%0d%0aX-Evil=c&Content-Length=1&Connection=x"));
  EXPECT_EQ(reply.field("X-Out"), "a  X-Evil: b ");
  EXPECT_EQ(reply.head.find("\r\nX-Evil"), std::string::npos);
  EXPECT_EQ(reply.head.find("X-Bad"), std::string::npos);
  EXPECT_EQ(reply.field("Content-Length"), "0");
  EXPECT_EQ(reply.field("Connection"), "");
}

}  // namespace
}  // namespace papilio::server
