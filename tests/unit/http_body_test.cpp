#include "tests/support/http_fixture.h"

// Bodies and forms: complete, damaged, too large or too slow. None is parsed as the next request.

namespace papilio::server {
namespace {

// Bodies

TEST_F(HttpServerTest, BodiesOfEitherFramingAreRead) {
  start();
  Client client(port_);
  EXPECT_EQ(client.ask(post("/echo", std::string(body_limit, 'x'))).body, std::string(body_limit, 'x'));
  EXPECT_EQ(client.ask(post("/echo", "")).body, "");
  const std::string chunked = "Transfer-Encoding: Chunked\r\n";
  EXPECT_EQ(client.ask(request("POST /echo", chunked, "5\r\nhello\r\n1;ext=1\r\n!\r\n0\r\nTrailer: x\r\n\r\n")).body,
            "hello!");
  EXPECT_EQ(client.ask(request("POST /echo", chunked, "0\r\n\r\n")).body, "");
  EXPECT_EQ(client.ask(get("/hello")).status, 200);
}

TEST_F(HttpServerTest, BodySentByteByByteIsRead) {
  start();
  Client client(port_);
  for (const char c : request("POST /echo", "Transfer-Encoding: chunked\r\n", "5\r\nhello\r\n0\r\n\r\n")) {
    ASSERT_TRUE(client.send({&c, 1}));
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(client.receive().body, "hello");
}

TEST_F(HttpServerTest, TooLargeContentLengthIsRefusedBeforeTheBody) {
  start();
  const std::string head = request("POST /echo", "Content-Length: 4097\r\n");
  expect_refused(head, 413, "body_too_large");
  expect_refused(request("POST /echo", "Content-Length: 99999999999999999999999\r\n"), 413, "body_too_large");
  EXPECT_NE(ask(head).body.find("4096 bytes"), std::string::npos) << "the limit is named";
}

TEST_F(HttpServerTest, TooLargeBodyIsNotParsedAsARequest) {
  start();
  std::string body;
  while (body.size() < 2 * body_limit) body += smuggled;
  expect_refused(post("/echo", body), 413, "body_too_large");
}

TEST_F(HttpServerTest, ClientOfATooLargeUploadReceivesTheRefusal) {
  start();
  Client client(port_);
  client.send(request("POST /echo", "Content-Length: 1000000\r\n"));
  const std::string some(50000, 'x');
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(client.send(some)) << "a reset would lose the answer";
  expect_problem(client.receive(), 413, "body_too_large");
  EXPECT_TRUE(client.at_end());
}

TEST_F(HttpServerTest, ChunkedBodyIsRefusedOnceItExceedsTheLimit) {
  start();
  const std::string chunked = "Transfer-Encoding: chunked\r\n";
  const std::string chunk = "800\r\n" + std::string(0x800, 'x') + "\r\n";
  EXPECT_EQ(ask(request("POST /echo", chunked, chunk + chunk + "0\r\n\r\n")).body.size(), body_limit);
  expect_refused(request("POST /echo", chunked, chunk + chunk + "1\r\n"), 413, "body_too_large");
  expect_refused(request("POST /echo", chunked, "7fffffffffffffff\r\n" + smuggled), 413, "body_too_large");
  expect_refused(request("POST /echo", chunked, "1\r\nx\r\nffffffffffffffff\r\n"), 413, "body_too_large");
  expect_refused(request("POST /echo", chunked, "10000000000000000000000\r\n"), 413, "body_too_large");
}

TEST_F(HttpServerTest, DamagedChunkingIsRefused) {
  start();
  for (const std::string& body :
       {"5\r\nhelloXX\r\n0\r\n\r\n" + smuggled, "-1\r\nx\r\n" + smuggled, "0x1\r\nx\r\n0\r\n\r\n" + smuggled,
        "+1\r\nx\r\n0\r\n\r\n" + smuggled, "\r\n\r\n" + smuggled, "1\nx\r\n0\r\n\r\n" + smuggled,
        "5 5\r\nhello\r\n0\r\n\r\n" + smuggled, "1;" + std::string(1000, 'e') + "\r\nx\r\n0\r\n\r\n" + smuggled}) {
    expect_refused(request("POST /echo", "Transfer-Encoding: chunked\r\n", body), 400, "bad_request");
  }
  std::string endless = "0\r\n";
  for (int i = 0; i < 100; ++i) endless += "Trailer: " + std::string(200, 't') + "\r\n";
  expect_refused(request("POST /echo", "Transfer-Encoding: chunked\r\n", endless), 400, "bad_request");
}

TEST_F(HttpServerTest, ChunkExtensionsOfTheGrammarAreIgnored) {
  start();
  Client client(port_);
  for (const char* line : {"5;a", "5 ; a", "5\t;\ta = b", "05;a=b;c=\"d;\\\" \t\xc3\xa4\";e"}) {
    SCOPED_TRACE(line);
    const std::string body = std::string(line) + "\r\nhello\r\n0;last\r\n\r\n";
    EXPECT_EQ(client.ask(request("POST /echo", "Transfer-Encoding: chunked\r\n", body)).body, "hello");
  }
}

TEST_F(HttpServerTest, ChunkLinesOutsideTheGrammarAreRefused) {
  start();
  using namespace std::string_literals;
  for (const std::string& line :
       {"5;a\rb"s,     "5;\r"s,    "5\r"s,       "5;a=\"\rb\""s, "5;a=\"\\\r\""s, "5;a\0"s,      "5\0"s,
        "5;a=\"\0\""s, "5;a\x7f"s, "5;a\x01=b"s, " 5"s,          "5 "s,           "5;"s,         "5;a="s,
        "5;=b"s,       "5;a=\"b"s, "5;a b"s,     "5;a=b c"s,     "5 a"s,          "5\xc2\xa0;a"s}) {
    const std::string body = line + "\r\nhello\r\n0\r\n\r\n" + smuggled;
    expect_refused(request("POST /echo", "Transfer-Encoding: chunked\r\n", body), 400, "bad_request");
  }
}

TEST_F(HttpServerTest, MalformedTrailersAreRefused) {
  start();
  using namespace std::string_literals;
  for (const std::string& trailer : {"X: a\rb"s, "X: \0"s, "no colon"s, " folded: x"s, "X : y"s}) {
    const std::string body = "5\r\nhello\r\n0\r\n" + trailer + "\r\n\r\n" + smuggled;
    expect_refused(request("POST /echo", "Transfer-Encoding: chunked\r\n", body), 400, "bad_request");
  }
}

TEST_F(HttpServerTest, BodyThatEndsEarlyIsRefused) {
  start();
  for (const std::string& bytes : {request("POST /echo", "Content-Length: 10\r\n", "short"),
                                   request("POST /echo", "Transfer-Encoding: chunked\r\n", "5\r\nhel")}) {
    Client client(port_);
    client.send(bytes);
    client.close();
  }
  const auto log = finished(2);
  ASSERT_EQ(log.size(), 2u);
  for (const Finished& one : log) EXPECT_EQ(one.code, "bad_request");
}

TEST_F(HttpServerTest, ExpectContinueIsAnsweredWhenTheBodyIsRead) {
  start();
  Client client(port_);
  EXPECT_EQ(client.ask(request("POST /echo", "Content-Length: 5\r\nExpect: 100-Continue\r\n")).status, 100);
  EXPECT_EQ(client.ask("hello").body, "hello");
}

TEST_F(HttpServerTest, ExpectContinueIsRefusedWithoutTheUpload) {
  start();
  const std::string expect = "Expect: 100-continue\r\nContent-Length: ";
  expect_refused(request("POST /echo", expect + "4097\r\n"), 413, "body_too_large");
  expect_refused(request("POST /refuse", expect + "10\r\n"), 400, "bad_parameter");
  expect_refused(request("POST /nowhere", expect + "10\r\n"), 404, "not_found");
}

TEST_F(HttpServerTest, EncodedBodiesAreRefused) {
  start();
  for (const char* encoding : {"gzip", "deflate", "br", "zstd", "identity, gzip"})
    expect_refused(post("/echo", smuggled, "Content-Encoding: " + std::string(encoding) + "\r\n"), 415,
                   "unsupported_encoding");
  expect_refused(post("/echo", smuggled, "Content-Encoding: identity\r\nContent-Encoding: gzip\r\n"), 415,
                 "unsupported_encoding");
  EXPECT_EQ(ask(post("/echo", "plain", "Content-Encoding: Identity\r\n")).body, "plain");
}

TEST_F(HttpServerTest, RangesAreRefused) {
  start();
  std::string many = "bytes=0-1";
  for (int i = 0; i < 300; ++i) many += ",0-1";
  expect_problem(ask(get("/hello", "Range: " + many + "\r\n")), 416, "range_not_supported");
  expect_problem(ask(get("/stream", "Range: nonsense\r\n")), 416, "range_not_supported");
}

TEST_F(HttpServerTest, PostWithoutLengthIsRefusedAtOnce) {
  start();
  expect_problem(ask(request("POST /echo")), 411, "length_required");
}

TEST_F(HttpServerTest, UnreadBodiesAreNotParsedAsRequests) {
  start();
  expect_refused(post("/refuse", smuggled), 400, "bad_parameter");
  expect_refused(post("/nowhere", smuggled), 404, "not_found");
  expect_refused(post("/hello", smuggled), 405, "method_not_allowed");
  Client client(port_);
  const std::string length = "Content-Length: " + std::to_string(smuggled.size()) + "\r\n";
  const Reply reply = client.ask(request("GET /hello", length, smuggled));
  EXPECT_EQ(reply.status, 200) << "a body on GET is lawful";
  EXPECT_EQ(reply.field("Connection"), "close");
  EXPECT_TRUE(client.at_end());
  EXPECT_EQ(counted_, 0);
}

TEST_F(HttpServerTest, ReadingABodyTwiceIsAnInternalError) {
  start();
  expect_problem(ask(post("/twice", "x")), 500, "internal");
}

// Forms

TEST_F(HttpServerTest, FormPartsAreRead) {
  start();
  Client client(port_);
  const Reply reply =
      client.ask(form("preamble\r\n--cut\r\nContent-Disposition: form-data; filename=\"a;b\"; name=\"mesh\"\r\n"
                      "content-type: application/x-draco\r\n\r\n\r\n--cu\r\nbytes\r\n"
                      "--cut  \r\nContent-Disposition: form-data; name=params\r\n\r\n{}\r\n"
                      "--cut\r\nContent-Disposition: form-data; name=\"a \\\"b\\\"\"\r\n\r\n\r\n--cut--"));
  EXPECT_EQ(reply.body, "mesh|application/x-draco|\r\n--cu\r\nbytes;params||{};a \"b\"||;");
  EXPECT_EQ(client.ask(form("--cut--\r\n")).body, "");
  EXPECT_EQ(client
                .ask(form("--c=t:\r\nContent-Disposition: form-data; name=n\r\n\r\nv\r\n--c=t:--\r\nepilogue",
                          "\"c=t:\"; charset=utf-8"))
                .body,
            "n||v;");
}

TEST_F(HttpServerTest, DamagedFormsAreRefused) {
  start();
  const std::string part = "--cut\r\nContent-Disposition: form-data; name=n\r\n\r\nv\r\n";
  for (const std::string& body :
       {std::string(), std::string("--cut"), part, std::string("nothing"), std::string("--other--"),
        part + "--cutter--", std::string("--cut\r\n\r\nno name\r\n--cut--"),
        std::string("--cut\r\nContent-Disposition: form-data; name=n"), "--cut\r\nX: " + std::string(4000, 'x')}) {
    SCOPED_TRACE(body.substr(0, 100));
    expect_problem(ask(form(body)), 400, "bad_request");
  }
  const std::string good = part + "--cut--";
  for (const std::string& boundary :
       {std::string(), std::string("\"\""), std::string(71, 'x'), std::string("\"a\xff\"")})
    expect_problem(ask(form(good, boundary)), 400, "bad_request");
  expect_problem(ask(post("/form", good, "Content-Type: multipart/form-data\r\n")), 400, "bad_request");
  expect_problem(ask(post("/form", good, "Content-Type: multipart/form-data; notboundary=cut\r\n")), 400,
                 "bad_request");
}

TEST_F(HttpServerTest, FormsHaveALimitedNumberOfParts) {
  options_.max_body_bytes = 1 << 20;
  start();
  std::string body;
  for (int i = 0; i < 65; ++i) body += "--cut\r\nContent-Disposition: form-data; name=n\r\n\r\nv\r\n";
  expect_problem(ask(form(body + "--cut--")), 400, "bad_request");
}

TEST_F(HttpServerTest, LongPartHeadersDoNotOverflowTheStack) {
  options_.max_body_bytes = 8 << 20;
  start();
  const std::string name(4 << 20, 'n');
  expect_problem(ask(form("--cut\r\nContent-Disposition: form-data; name=\"" + name + "\"\r\n\r\nv\r\n--cut--")), 400,
                 "bad_request");
}

}  // namespace
}  // namespace papilio::server
