"""stub_server.py: an HTTP server behind a proxy, which answers what the proxy has sent it. Prints its port.

/drop: the first request is dropped without an answer. /v1/meshes/NAME/refined: with an ETag and `Cache-Control: NAME`;
304 to a matching If-None-Match. The header Count says how many requests there were for this address before.
/raw/FILE/...: the whole answer is that file in this folder, byte for byte, and the connection is closed after it.
"""
import collections
import http.server

counts = collections.Counter()


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def answer(self):
        self.rfile.read(int(self.headers.get("Content-Length", 0)))
        count = counts[self.path]
        counts[self.path] += 1
        if self.path.startswith("/drop") and count == 0:
            self.close_connection = True
            return
        if self.path.startswith("/raw/"):
            with open(self.path.split("/")[2], "rb") as answer:
                self.wfile.write(answer.read())
            self.close_connection = True
            return
        name = self.path.split("/")[3] if self.path.startswith("/v1/meshes/") else None
        unchanged = name is not None and self.headers.get("If-None-Match") == '"tag"'
        body = b"" if unchanged else str(self.headers).encode()
        self.send_response(304 if unchanged else 200)
        self.send_header("Count", str(count))
        if name is not None:
            self.send_header("ETag", '"tag"')
            self.send_header("Cache-Control", name.replace("_", ", "))
        if not unchanged:
            self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(body)

    do_GET = do_HEAD = do_POST = answer

    def log_message(self, *_):
        pass


server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
print(server.server_address[1], flush=True)
server.serve_forever()
