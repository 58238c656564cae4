-- Wireshark dissector for the railcast protocol, version 1 (docs/stream.md).
--
--   wireshark -X lua_script:scripts/railcast.lua
--   tshark -X lua_script:scripts/railcast.lua -f "udp port 27400" -Y 'railcast.crc.status == "bad"'
--
-- Knows its datagrams at any port by magic and version; port 27400 is taken for it in any case.
-- On the sending machine a capture shows datagrams that left at once as one (UDP segmentation
-- offload): they are cut by their own sizes, and shown each by itself.

local DEFAULT_PORT = 27400
local NUM_SHOWN_POINTS = 10
local FIELDS_AT = 170
local TRAILER_SIZE = 4

-- Code -> name, size in bytes.
local TYPES = { [2] = { "u8", 1 }, [4] = { "u16", 2 }, [6] = { "u32", 4 }, [7] = { "f32", 4 } }

local railcast = Proto("railcast", "railcast point stream")

-- Where a header member is, its size, its ProtoField.
local MEMBERS = {
  { 0, 4, ProtoField.string("railcast.magic", "Magic") },
  { 4, 1, ProtoField.uint8("railcast.version", "Version") },
  { 5, 1, ProtoField.uint8("railcast.flags", "Flags", base.HEX) },
  { 5, 1, ProtoField.bool("railcast.flags.all_slots", "All slots are sent", 8, nil, 1) },
  { 5, 1, ProtoField.uint8("railcast.flags.axes", "Axes", base.DEC,
    { [0] = "sensor", [1] = "vehicle", [2] = "world" }, 6) },
  { 5, 1, ProtoField.bool("railcast.flags.left_handed", "Left-handed", 8, nil, 8) },
  { 6, 2, ProtoField.uint16("railcast.header_size", "Header size") },
  { 8, 4, ProtoField.uint32("railcast.run", "Run") },
  { 12, 2, ProtoField.uint16("railcast.sensor", "Sensor") },
  { 14, 2, ProtoField.uint16("railcast.points", "Points in this datagram") },
  { 16, 4, ProtoField.uint32("railcast.frame", "Frame") },
  { 20, 2, ProtoField.uint16("railcast.packet", "Packet") },
  { 22, 2, ProtoField.uint16("railcast.packets", "Packets in frame") },
  { 24, 8, ProtoField.int64("railcast.stamp_ns", "Stamp (ns)") },
  { 32, 4, ProtoField.uint32("railcast.duration_ns", "Duration (ns)") },
  { 36, 4, ProtoField.uint32("railcast.frame_points", "Points in frame") },
  { 40, 4, ProtoField.uint32("railcast.first_point", "First point of this datagram") },
  { 44, 4, ProtoField.uint32("railcast.rows", "Rows") },
  { 48, 4, ProtoField.uint32("railcast.columns", "Columns") },
  { 52, 2, ProtoField.uint16("railcast.returns", "Returns") },
  { 54, 2, ProtoField.uint16("railcast.point_size", "Point size") },
}

local POSES = {
  { 56, "pose", "World from sensor at the stamp" },
  { 112, "end_pose", "World from sensor at the last firing" },
}
local pose_fields = {}
for _, pose in ipairs(POSES) do
  for i, axis in ipairs({ "x", "y", "z", "qx", "qy", "qz", "qw" }) do
    pose_fields[#pose_fields + 1] =
      { pose[1] + 8 * (i - 1), ProtoField.double("railcast." .. pose[2] .. "." .. axis, axis) }
  end
end

local num_fields = ProtoField.uint16("railcast.fields", "Fields")
local field_type = ProtoField.uint8("railcast.field.type", "Type", base.DEC,
  { [2] = "u8", [4] = "u16", [6] = "u32", [7] = "f32" })
local field_name = ProtoField.string("railcast.field.name", "Name")
local value_of = {
  [2] = ProtoField.uint8("railcast.point.u8", "u8"),
  [4] = ProtoField.uint16("railcast.point.u16", "u16"),
  [6] = ProtoField.uint32("railcast.point.u32", "u32"),
  [7] = ProtoField.float("railcast.point.f32", "f32"),
}
local crc = ProtoField.uint32("railcast.crc", "CRC-32", base.HEX)
local crc_status = ProtoField.string("railcast.crc.status", "CRC-32 status")

local all = { num_fields, field_type, field_name, crc, crc_status }
for _, member in ipairs(MEMBERS) do all[#all + 1] = member[3] end
for _, value in ipairs(pose_fields) do all[#all + 1] = value[2] end
for _, value in pairs(value_of) do all[#all + 1] = value end
railcast.fields = all

local bad_crc = ProtoExpert.new("railcast.crc.bad", "The CRC-32 is wrong",
  expert.group.CHECKSUM, expert.severity.ERROR)
local bad_sizes = ProtoExpert.new("railcast.malformed", "The sizes contradict each other",
  expert.group.MALFORMED, expert.severity.ERROR)
railcast.experts = { bad_crc, bad_sizes }

local crc_table = {}
for byte = 0, 255 do
  local rest = byte
  for _ = 1, 8 do
    rest = rest % 2 == 1 and bit32.bxor(bit32.rshift(rest, 1), 0xEDB88320) or bit32.rshift(rest, 1)
  end
  crc_table[byte] = rest
end

-- As zlib has it.
local function crc32(range)
  local bytes = range:bytes()
  local rest = 0xFFFFFFFF
  for i = 0, bytes:len() - 1 do
    local index = bit32.band(bit32.bxor(rest, bytes:get_index(i)), 0xFF)
    rest = bit32.bxor(crc_table[index], bit32.rshift(rest, 8))
  end
  return bit32.bxor(rest, 0xFFFFFFFF)
end

-- "good", "bad", or "cut" where the capture kept only the beginning.
local function add_crc(buffer, tree, is_cut)
  if is_cut then
    tree:add(crc_status, "cut"):set_generated()
    return "cut"
  end
  local at = buffer:len() - TRAILER_SIZE
  local status = crc32(buffer(0, at)) == buffer(at, TRAILER_SIZE):le_uint() and "good" or "bad"
  local item = tree:add_le(crc, buffer(at, TRAILER_SIZE))
  item:append_text(status == "good" and " [correct]" or " [wrong]")
  tree:add(crc_status, buffer(at, TRAILER_SIZE), status):set_generated()
  if status == "bad" then item:add_proto_expert_info(bad_crc) end
  return status
end

-- The fields as { name, type code, offset in a point }; nil if the list does not fit.
local function add_fields(buffer, tree, header_size)
  local fields = {}
  local offset, at = 0, FIELDS_AT
  local branch = tree:add_le(num_fields, buffer(FIELDS_AT - 2, 2))
  for i = 1, buffer(FIELDS_AT - 2, 2):le_uint() do
    if at + 2 > header_size then return nil end
    local code, length = buffer(at, 1):uint(), buffer(at + 1, 1):uint()
    if TYPES[code] == nil or length == 0 or at + 2 + length > header_size then return nil end
    local name = buffer(at + 2, length):string()
    local leaf = branch:add(buffer(at, 2 + length), name .. ": " .. TYPES[code][1])
    leaf:add(field_type, buffer(at, 1))
    leaf:add(field_name, buffer(at + 2, length))
    fields[i] = { name, code, offset }
    offset = offset + TYPES[code][2]
    at = at + 2 + length
  end
  return fields, offset
end

local function add_points(buffer, tree, header_size, fields, point_size)
  local num_points = buffer(14, 2):le_uint()
  local first = buffer(40, 4):le_uint()
  local branch = tree:add(buffer(header_size, num_points * point_size),
    "Points: " .. num_points .. ", the first " .. NUM_SHOWN_POINTS .. " of them shown")
  for i = 0, math.min(num_points, NUM_SHOWN_POINTS) - 1 do
    local at = header_size + i * point_size
    local point = branch:add(buffer(at, point_size), "Point " .. first + i)
    for _, field in ipairs(fields) do
      local name, code, offset = field[1], field[2], field[3]
      point:add_le(value_of[code], buffer(at + offset, TYPES[code][2])):prepend_text(name .. " ")
    end
  end
end

local function is_ours(buffer)
  return buffer:len() >= FIELDS_AT + TRAILER_SIZE and buffer(0, 4):string() == "RCST"
    and buffer(4, 1):uint() == 1
end

-- What the header says of the size of its datagram; nil if that cannot be.
local function size_by_header(buffer)
  local header_size, point_size = buffer(6, 2):le_uint(), buffer(54, 2):le_uint()
  if header_size < FIELDS_AT or point_size == 0 then return nil end
  return header_size + buffer(14, 2):le_uint() * point_size + TRAILER_SIZE
end

-- Adds one datagram. Returns its CRC's status.
local function add_datagram(buffer, tree, is_cut)
  local branch = tree:add(railcast, buffer())
  for _, member in ipairs(MEMBERS) do branch:add_le(member[3], buffer(member[1], member[2])) end
  for _, pose in ipairs(POSES) do
    local leaves = branch:add(buffer(pose[1], 56), pose[3])
    for _, value in ipairs(pose_fields) do
      if value[1] >= pose[1] and value[1] < pose[1] + 56 then
        leaves:add_le(value[2], buffer(value[1], 8))
      end
    end
  end
  local status = add_crc(buffer, branch, is_cut)
  if status == "cut" then return status end
  if size_by_header(buffer) ~= buffer:len() then
    branch:add_proto_expert_info(bad_sizes)
    return status
  end
  local header_size, point_size = buffer(6, 2):le_uint(), buffer(54, 2):le_uint()
  local fields, sum = add_fields(buffer, branch, header_size)
  if fields == nil or sum ~= point_size then
    branch:add_proto_expert_info(bad_sizes)
  elseif buffer(14, 2):le_uint() > 0 then
    add_points(buffer, branch, header_size, fields, point_size)
  end
  return status
end

local function summary(buffer)
  return string.format("Run %d, frame %d, packet %d of %d, %d points",
    buffer(8, 4):le_uint(), buffer(16, 4):le_uint(), buffer(20, 2):le_uint(),
    buffer(22, 2):le_uint(), buffer(14, 2):le_uint())
end

-- The first of several datagrams in one, and the others; the whole, and nil, if it is only one.
-- What follows a datagram and begins none belongs to it: then its sizes contradict each other.
local function take_first(buffer)
  local size = size_by_header(buffer)
  if size == nil or size >= buffer:len() then return buffer, nil end
  local others = buffer(size):tvb()
  if not is_ours(others) then return buffer, nil end
  return buffer(0, size):tvb(), others
end

function railcast.dissector(buffer, packet, tree)
  if not is_ours(buffer) then return 0 end
  packet.cols.protocol = "railcast"
  local text = summary(buffer)
  local count, rest, num_of = 0, buffer, { good = 0, bad = 0, cut = 0 }
  while rest ~= nil do
    local first
    first, rest = take_first(rest)
    local is_cut = rest == nil and buffer:reported_len() > buffer:len()
    local status = add_datagram(first, tree, is_cut)
    num_of[status] = num_of[status] + 1
    count = count + 1
  end
  if count > 1 then text = count .. " datagrams in one, the first: " .. text end
  if num_of.bad > 0 then text = text .. " [CRC wrong]" end
  if num_of.cut > 0 then text = text .. " [not captured whole]" end
  packet.cols.info = text
  return buffer:len()
end

DissectorTable.get("udp.port"):add(DEFAULT_PORT, railcast)
railcast:register_heuristic("udp", function(buffer, packet, tree)
  if not is_ours(buffer) then return false end
  railcast.dissector(buffer, packet, tree)
  return true
end)
