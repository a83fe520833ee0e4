-- wrk: POSTs the mesh in PAPILIO_MESH, or GETs where there is none; every answer must be 200. Ends with a line of figures:
-- requests, a second, median and 99th percentile of ms, and how many were not answered so.
local name = os.getenv("PAPILIO_MESH")
if name and name ~= "" then
  wrk.method = "POST"
  wrk.headers["Content-Type"] = "application/x-draco"
  local file = assert(io.open(name, "rb"))
  wrk.body = file:read("*a")
  file:close()
end

-- EYE in the path: in each request another place of the viewer.
local path = wrk.path
if path:find("EYE", 1, true) then
  math.randomseed(os.time()) -- the proxy has kept those of the last run
  function request()
    local angle = math.random() * 2 * math.pi
    return wrk.format(nil, (path:gsub("EYE", string.format("%.9f,0.1,%.9f", math.cos(angle) / 2, math.sin(angle) / 2))))
  end
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
  print(string.format("figures: %d %.2f %.1f %.1f %d", summary.requests, summary.requests / summary.duration * 1e6,
    latency:percentile(50) / 1000, latency:percentile(99) / 1000, refused))
end
