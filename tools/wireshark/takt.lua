-- Wireshark and tshark: what takt puts on the wire and they do not know.
--
--   tshark -X lua_script:tools/wireshark/takt.lua -r all.pcapng
--
-- OPC UA PubSub (UADP, OPC 10000-14 7.2.4) on EtherType 0xB62C and on UDP port 4840: headers in full, and in the messages of Programs the fields of their layouts
-- (src/protocol/wire/README.md). Traffic that a scenario describes without a protocol: the mark "TAKT", the number of the stream, the sequence number.

local uadp = Proto("takt_uadp", "OPC UA PubSub (UADP)")
local u = {
  version = ProtoField.uint8("takt_uadp.version", "Version"),
  publisher = ProtoField.string("takt_uadp.publisher_id", "PublisherId"),
  class_id = ProtoField.guid("takt_uadp.data_set_class_id", "DataSetClassId"),
  group = ProtoField.uint16("takt_uadp.writer_group_id", "WriterGroupId"),
  group_version = ProtoField.uint32("takt_uadp.group_version", "GroupVersion", base.HEX),
  message_number = ProtoField.uint16("takt_uadp.network_message_number", "NetworkMessageNumber"),
  sequence = ProtoField.uint16("takt_uadp.sequence_number", "SequenceNumber"),
  count = ProtoField.uint8("takt_uadp.count", "DataSetMessages"),
  writer = ProtoField.uint16("takt_uadp.data_set_writer_id", "DataSetWriterId"),
  timestamp = ProtoField.uint64("takt_uadp.timestamp", "Timestamp (100 ns since 1601)"),
  picoseconds = ProtoField.uint16("takt_uadp.picoseconds", "PicoSeconds"),
  token = ProtoField.uint32("takt_uadp.security_token_id", "SecurityTokenId"),
  nonce = ProtoField.bytes("takt_uadp.message_nonce", "MessageNonce"),
  encrypted = ProtoField.bytes("takt_uadp.encrypted", "Encrypted, or signed"),
  valid = ProtoField.bool("takt_uadp.valid", "Valid"),
  encoding = ProtoField.uint8("takt_uadp.field_encoding", "Field encoding", base.DEC, {[0] = "Variant", [1] = "RawData", [2] = "DataValue"}),
  kind = ProtoField.uint8("takt_uadp.message_type", "DataSetMessage", base.DEC, {[0] = "key frame", [1] = "delta frame", [2] = "event", [3] = "keep alive"}),
  message_sequence = ProtoField.uint16("takt_uadp.data_set_message_sequence_number", "DataSetMessage sequence number"),
  status = ProtoField.uint16("takt_uadp.status", "Status", base.HEX),
  major = ProtoField.uint32("takt_uadp.major_version", "ConfigurationVersion, major"),
  minor = ProtoField.uint32("takt_uadp.minor_version", "ConfigurationVersion, minor"),
  fields = ProtoField.bytes("takt_uadp.fields", "Fields"),
  padding = ProtoField.bytes("takt_uadp.padding", "Padding"),
  state = ProtoField.uint32("takt_uadp.program.state", "CurrentState", base.DEC, {[11] = "Halted", [12] = "Ready", [13] = "Running", [14] = "Suspended", [15] = "Halted.INIT"}),
  incarnation = ProtoField.uint32("takt_uadp.program.incarnation", "Incarnation"),
  run = ProtoField.uint32("takt_uadp.program.run", "Run"),
  intent_number = ProtoField.uint32("takt_uadp.program.intent_number", "Intent, number"),
  intent_run = ProtoField.uint32("takt_uadp.program.intent_run", "Intent, run"),
  intent_kind = ProtoField.uint8("takt_uadp.program.intent_kind", "Intent, kind"),
  intent_origin = ProtoField.uint8("takt_uadp.program.intent_origin", "Intent, origin"),
  life = ProtoField.uint32("takt_uadp.program.life", "Life"),
  leaving = ProtoField.uint8("takt_uadp.program.leaving", "Leaving"),
  skill = ProtoField.uint32("takt_uadp.program.skill", "Skill (FNV-1a of its name)", base.HEX),
  data = ProtoField.bytes("takt_uadp.program.data", "Fields of the data set"),
}
for _, field in pairs(u) do uadp.fields[#uadp.fields + 1] = field end
local cut_short = ProtoExpert.new("takt_uadp.cut_short", "The message ends within its headers", expert.group.MALFORMED, expert.severity.ERROR)
uadp.experts = {cut_short}

-- A reader that knows where it is and never goes beyond the end: read() fails softly.
local Reader = {}
Reader.__index = Reader
function Reader.new(buffer) return setmetatable({buffer = buffer, at = 0, failed = false}, Reader) end
function Reader:left() return self.buffer:len() - self.at end
function Reader:take(count)
  if self.failed or count < 0 or self:left() < count then
    self.failed = true
    return nil
  end
  local range = self.buffer(self.at, count)
  self.at = self.at + count
  return range
end
function Reader:add(tree, field, count)
  local range = self:take(count)
  if range then tree:add_le(field, range) end
  return range
end
local function has(flags, bit_number) return bit.band(flags, bit.lshift(1, bit_number)) ~= 0 end

local function publisher_id(reader, tree, kind)
  local sizes = {[0] = 1, [1] = 2, [2] = 4, [3] = 8}
  if kind == 4 then
    local length = reader:take(4)
    local text = length and reader:take(length:le_uint())
    if text then tree:add(u.publisher, text, text:string()) end
    return text and text:string() or "?"
  end
  local range = reader:take(sizes[kind] or 0)
  if not range or range:len() == 0 then return "?" end
  local value = kind == 3 and tostring(range:le_uint64()) or tostring(range:le_uint())
  tree:add(u.publisher, range, value)
  return value
end

-- The fields of what Programs send, by WriterGroupId and length; nil: another layout.
local function program_fields(reader, tree, group, length)
  if group == 1 and (length == 4 or length == 22) then
    local state = reader:add(tree, u.state, 4)
    if length == 22 then
      reader:add(tree, u.incarnation, 4)
      reader:add(tree, u.run, 4)
      reader:add(tree, u.intent_number, 4)
      reader:add(tree, u.intent_run, 4)
      reader:add(tree, u.intent_kind, 1)
      reader:add(tree, u.intent_origin, 1)
    end
    return "state " .. tostring(state and state:le_uint())
  end
  if group == 0xFF00 and length == 37 then
    reader:add(tree, u.life, 4)
    reader:add(tree, u.leaving, 1)
    for _ = 1, 8 do reader:add(tree, u.skill, 4) end
    return "announcement"
  end
  if group == 0xFF01 and length >= 4 then
    reader:add(tree, u.incarnation, 4)
    reader:add(tree, u.data, length - 4)
    return "bindings"
  end
  if group >= 2 and group < 0xFF00 and length >= 4 then
    reader:add(tree, u.run, 4)
    reader:add(tree, u.data, length - 4)
    return "process data " .. (group - 2)
  end
  return nil
end

local function data_set_message(reader, tree, size, fixed, group)
  local begin = reader.at
  local message = tree:add(uadp, reader.buffer(begin), "DataSetMessage")
  local first = reader:take(1)
  if not first then return nil end
  local flags = first:uint()
  message:add(u.valid, first, has(flags, 0))
  local encoding = bit.band(bit.rshift(flags, 1), 3)
  message:add(u.encoding, first, encoding)
  local kind = 0
  local more = 0
  if has(flags, 7) then
    local second = reader:take(1)
    if not second then return nil end
    more = second:uint()
    kind = bit.band(more, 15)
  end
  message:add(u.kind, first, kind)
  if has(flags, 3) then reader:add(message, u.message_sequence, 2) end
  if has(more, 4) then reader:add(message, u.timestamp, 8) end
  if has(more, 5) then reader:add(message, u.picoseconds, 2) end
  if has(flags, 4) then reader:add(message, u.status, 2) end
  if has(flags, 5) then reader:add(message, u.major, 4) end
  if has(flags, 6) then reader:add(message, u.minor, 4) end
  local length = size and (size - (reader.at - begin)) or reader:left()
  if length < 0 then reader.failed = true end
  if reader.failed then return nil end
  local what = nil
  if encoding == 1 and kind == 0 and fixed then what = program_fields(reader, message, group, length) end
  if not what and length > 0 then reader:add(message, u.fields, length) end
  message:set_len(reader.at - begin)
  return what or (kind == 3 and "keep alive" or "data set")
end

function uadp.dissector(buffer, info, root)
  info.cols.protocol = "UADP"
  local tree = root:add(uadp, buffer())
  local reader = Reader.new(buffer)
  local what, publisher, group
  local first = reader:take(1)
  if first then
    local flags = first:uint()
    tree:add(u.version, first, bit.band(flags, 15))
    local extended1, extended2 = 0, 0
    if has(flags, 7) then
      local range = reader:take(1)
      extended1 = range and range:uint() or 0
      if has(extended1, 7) then
        range = reader:take(1)
        extended2 = range and range:uint() or 0
      end
    end
    if has(flags, 4) then publisher = publisher_id(reader, tree, bit.band(extended1, 7)) end
    if has(extended1, 3) then reader:add(tree, u.class_id, 16) end
    if has(flags, 5) then
      local range = reader:take(1)
      local of_group = range and range:uint() or 0
      if has(of_group, 0) then
        local id = reader:add(tree, u.group, 2)
        group = id and id:le_uint()
      end
      if has(of_group, 1) then reader:add(tree, u.group_version, 4) end
      if has(of_group, 2) then reader:add(tree, u.message_number, 2) end
      if has(of_group, 3) then reader:add(tree, u.sequence, 2) end
    end
    local count = 1
    local has_payload_header = has(flags, 6)
    if has_payload_header then
      local range = reader:add(tree, u.count, 1)
      count = range and range:uint() or 0
      for _ = 1, count do reader:add(tree, u.writer, 2) end
    end
    if has(extended1, 5) then reader:add(tree, u.timestamp, 8) end
    if has(extended1, 6) then reader:add(tree, u.picoseconds, 2) end
    local encrypted = false
    if has(extended1, 4) then
      local range = reader:take(1)
      encrypted = range ~= nil and has(range:uint(), 1)
      reader:add(tree, u.token, 4)
      local length = reader:take(1)
      if length then reader:add(tree, u.nonce, length:uint()) end
      if range and has(range:uint(), 2) then reader:take(2) end
    end
    if encrypted then
      if reader:left() > 0 then reader:add(tree, u.encrypted, reader:left()) end
      what = "encrypted"
    elseif bit.band(bit.rshift(extended2, 2), 7) ~= 0 then
      if reader:left() > 0 then reader:add(tree, u.fields, reader:left()) end
      what = "discovery"
    else
      local sizes = {}
      if has_payload_header and count > 1 then
        for i = 1, count do
          local range = reader:take(2)
          sizes[i] = range and range:le_uint()
        end
      end
      -- In frames of the least length padding follows what Programs send: their layouts have no length of their own.
      local fixed = group ~= nil and not has_payload_header
      if fixed and group == 1 and #sizes == 0 then
        local left = reader:left()
        sizes[1] = left >= 27 and 27 or left >= 9 and 9 or left
      end
      for i = 1, count do
        if reader.failed then break end
        local one = data_set_message(reader, tree, sizes[i], fixed, group or 0)
        what = what or one
      end
    end
  end
  if not reader.failed and reader:left() > 0 then reader:add(tree, u.padding, reader:left()) end
  if reader.failed then tree:add_proto_expert_info(cut_short) end
  info.cols.info = string.format("%s%s%s", what or "?", publisher and (", publisher " .. publisher) or "", group and string.format(", group %d", group) or "")
  return buffer:len()
end

DissectorTable.get("ethertype"):add(0xB62C, uadp)
DissectorTable.get("udp.port"):add(4840, uadp)

local stream = Proto("takt_stream", "takt: traffic without a protocol")
local s = {
  number = ProtoField.uint32("takt_stream.number", "Stream, by its place in the scenario"),
  sequence = ProtoField.uint64("takt_stream.sequence", "Sequence number"),
  rest = ProtoField.bytes("takt_stream.rest", "Counting octets"),
}
for _, field in pairs(s) do stream.fields[#stream.fields + 1] = field end

local function is_takt(buffer) return buffer:len() >= 4 and buffer(0, 4):uint() == 0x54414B54 end

function stream.dissector(buffer, info, root)
  info.cols.protocol = "takt"
  local tree = root:add(stream, buffer())
  if is_takt(buffer) and buffer:len() >= 16 then
    tree:add(s.number, buffer(4, 4))
    tree:add(s.sequence, buffer(8, 8))
    info.cols.info = string.format("stream %d, frame %s", buffer(4, 4):uint(), tostring(buffer(8, 8):uint64()))
    if buffer:len() > 16 then tree:add(s.rest, buffer(16)) end
  else
    tree:add(s.rest, buffer())
    info.cols.info = string.format("%d octets", buffer:len())
  end
  return buffer:len()
end

-- Streams without protocol: the dynamic ports, if nobody has taken the datagram before, and the local experimental EtherType.
local function maybe(buffer, info, root)
  local is_uadp = info.dst_port == 4840
  if is_uadp or info.dst_port < 49152 or not (is_takt(buffer) or buffer:len() < 4) then return false end
  stream.dissector(buffer, info, root)
  return true
end
stream:register_heuristic("udp", maybe)
DissectorTable.get("ethertype"):add(0x88B5, stream)
