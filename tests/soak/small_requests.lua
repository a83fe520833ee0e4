-- For wrk: every other request a small refinement (the mesh is named by PAPILIO_SOAK_MESH), the rest GET /v1/info, each
-- connection at most a hundred times a second. Ends with one line of figures.

local refine, info
local count = 0
local threads = {}
busy, wrong = 0, 0 -- of a thread, for `done` to collect

function setup(thread)
  table.insert(threads, thread)
end

function init()
  local file = assert(io.open(os.getenv("PAPILIO_SOAK_MESH"), "rb"))
  refine = wrk.format("POST", "/v1/refine?levels=1", { ["Content-Type"] = "application/x-draco" }, file:read("*a"))
  file:close()
  info = wrk.format("GET", "/v1/info")
end

function request()
  count = count + 1
  return count % 2 == 0 and refine or info
end

function delay()
  return 10
end

function response(status)
  if status == 429 then
    busy = busy + 1
  elseif status ~= 200 then
    wrong = wrong + 1
  end
end

function done(summary, latency)
  local errors = summary.errors
  local busy, wrong = 0, 0
  for _, thread in ipairs(threads) do
    busy = busy + thread:get("busy")
    wrong = wrong + thread:get("wrong")
  end
  -- Where the server says with an answer that it closes the connection, wrk sees an error.
  io.write(string.format("wrk: %d small requests, p50 %.1f ms, p95 %.1f ms, p99 %.1f ms; busy %d, closed %d, wrong %d\n",
    summary.requests, latency:percentile(50) / 1000, latency:percentile(95) / 1000, latency:percentile(99) / 1000,
    busy, errors.read, wrong + errors.connect + errors.write + errors.timeout))
end
