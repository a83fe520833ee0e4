-- wrk: POSTs the mesh in PAPILIO_MESH, or GETs where there is none; every answer must be 200.
local name = os.getenv("PAPILIO_MESH")
if name and name ~= "" then
  wrk.method = "POST"
  wrk.headers["Content-Type"] = "application/x-draco"
  local file = assert(io.open(name, "rb"))
  wrk.body = file:read("*a")
  file:close()
end

wrong = 0
function response(status)
  if status ~= 200 then wrong = wrong + 1 end
end

local threads = {}
function setup(thread) table.insert(threads, thread) end

function done(summary, latency)
  local refused = summary.errors.connect + summary.errors.read + summary.errors.write + summary.errors.timeout
  for _, thread in ipairs(threads) do refused = refused + thread:get("wrong") end
  print(string.format("figures: %.2f %.1f %.1f %d", summary.requests / summary.duration * 1e6,
    latency:percentile(50) / 1000, latency:percentile(99) / 1000, refused))
end
