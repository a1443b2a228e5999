# SPDX-License-Identifier: Apache-2.0
"""Reads a PubSubConfigurationDataType from the binary file of OPC UA, by the tables of OPC 10000-14 and OPC 10000-6; shares nothing with what writes it."""
import struct

# A name and its type; "[]" is an array, the names of structures are keys of this table.
HEADER = [("Namespaces", "String[]"), ("StructureDataTypes", "Empty[]"), ("EnumDataTypes", "Empty[]"), ("SimpleDataTypes", "Empty[]")]
GROUP = [("Name", "String"), ("Enabled", "Boolean"), ("SecurityMode", "Int32"), ("SecurityGroupId", "String"), ("SecurityKeyServices", "Empty[]"), ("MaxNetworkMessageSize", "UInt32"), ("GroupProperties", "Empty[]")]
STRUCTURES = {
    "UABinaryFile": HEADER + [("SchemaLocation", "String"), ("FileHeader", "Empty[]"), ("Body", "Variant")],
    "PubSubConfiguration": [("PublishedDataSets", "PublishedDataSet[]"), ("Connections", "PubSubConnection[]"), ("Enabled", "Boolean")],
    "PublishedDataSet": [("Name", "String"), ("DataSetFolder", "String[]"), ("DataSetMetaData", "DataSetMetaData"), ("ExtensionFields", "Empty[]"), ("DataSetSource", "ExtensionObject")],
    "DataSetMetaData": HEADER + [("Name", "String"), ("Description", "LocalizedText"), ("Fields", "FieldMetaData[]"), ("DataSetClassId", "Guid"), ("MajorVersion", "UInt32"), ("MinorVersion", "UInt32")],
    "FieldMetaData": [("Name", "String"), ("Description", "LocalizedText"), ("FieldFlags", "UInt16"), ("BuiltInType", "Byte"), ("DataType", "NodeId"), ("ValueRank", "Int32"), ("ArrayDimensions", "UInt32[]"),
                      ("MaxStringLength", "UInt32"), ("DataSetFieldId", "Guid"), ("Properties", "Empty[]")],
    "PublishedDataItems": [("PublishedData", "PublishedVariable[]")],
    "PublishedVariable": [("PublishedVariable", "NodeId"), ("AttributeId", "UInt32"), ("SamplingIntervalHint", "Double"), ("DeadbandType", "UInt32"), ("DeadbandValue", "Double"), ("IndexRange", "String"),
                          ("SubstituteValue", "Variant"), ("MetaDataProperties", "Empty[]")],
    "PubSubConnection": [("Name", "String"), ("Enabled", "Boolean"), ("PublisherId", "Variant"), ("TransportProfileUri", "String"), ("Address", "ExtensionObject"), ("ConnectionProperties", "Empty[]"),
                         ("TransportSettings", "ExtensionObject"), ("WriterGroups", "WriterGroup[]"), ("ReaderGroups", "ReaderGroup[]")],
    "NetworkAddressUrl": [("NetworkInterface", "String"), ("Url", "String")],
    "WriterGroup": GROUP + [("WriterGroupId", "UInt16"), ("PublishingInterval", "Double"), ("KeepAliveTime", "Double"), ("Priority", "Byte"), ("LocaleIds", "String[]"), ("HeaderLayoutUri", "String"),
                            ("TransportSettings", "ExtensionObject"), ("MessageSettings", "ExtensionObject"), ("DataSetWriters", "DataSetWriter[]")],
    "UadpWriterGroupMessage": [("GroupVersion", "UInt32"), ("DataSetOrdering", "Int32"), ("NetworkMessageContentMask", "UInt32"), ("SamplingOffset", "Double"), ("PublishingOffset", "Double[]")],
    "DataSetWriter": [("Name", "String"), ("Enabled", "Boolean"), ("DataSetWriterId", "UInt16"), ("DataSetFieldContentMask", "UInt32"), ("KeyFrameCount", "UInt32"), ("DataSetName", "String"),
                      ("DataSetWriterProperties", "Empty[]"), ("TransportSettings", "ExtensionObject"), ("MessageSettings", "ExtensionObject")],
    "UadpDataSetWriterMessage": [("DataSetMessageContentMask", "UInt32"), ("ConfiguredSize", "UInt16"), ("NetworkMessageNumber", "UInt16"), ("DataSetOffset", "UInt16")],
    "ReaderGroup": GROUP + [("TransportSettings", "ExtensionObject"), ("MessageSettings", "ExtensionObject"), ("DataSetReaders", "DataSetReader[]")],
    "DataSetReader": [("Name", "String"), ("Enabled", "Boolean"), ("PublisherId", "Variant"), ("WriterGroupId", "UInt16"), ("DataSetWriterId", "UInt16"), ("DataSetMetaData", "DataSetMetaData"),
                      ("DataSetFieldContentMask", "UInt32"), ("MessageReceiveTimeout", "Double"), ("KeyFrameCount", "UInt32"), ("HeaderLayoutUri", "String"), ("SecurityMode", "Int32"), ("SecurityGroupId", "String"),
                      ("SecurityKeyServices", "Empty[]"), ("DataSetReaderProperties", "Empty[]"), ("TransportSettings", "ExtensionObject"), ("MessageSettings", "ExtensionObject"),
                      ("SubscribedDataSet", "ExtensionObject")],
    "UadpDataSetReaderMessage": [("GroupVersion", "UInt32"), ("NetworkMessageNumber", "UInt16"), ("DataSetOffset", "UInt16"), ("DataSetClassId", "Guid"), ("NetworkMessageContentMask", "UInt32"),
                                 ("DataSetMessageContentMask", "UInt32"), ("PublishingInterval", "Double"), ("ReceiveOffset", "Double"), ("ProcessingOffset", "Double")],
    "TargetVariables": [("TargetVariables", "FieldTarget[]")],
    "FieldTarget": [("DataSetFieldId", "Guid"), ("ReceiverIndexRange", "String"), ("TargetNodeId", "NodeId"), ("AttributeId", "UInt32"), ("WriteIndexRange", "String"), ("OverrideValueHandling", "Int32"),
                    ("OverrideValue", "Variant")],
}
# NodeIds of the default binary encodings (the core nodeset).
ENCODINGS = {15422: "UABinaryFile", 21154: "PubSubConfiguration", 15679: "PublishedDataItems", 21152: "NetworkAddressUrl", 15715: "UadpWriterGroupMessage", 15717: "UadpDataSetWriterMessage",
             15718: "UadpDataSetReaderMessage", 15712: "TargetVariables"}
NUMBERS = {"Boolean": "<?", "Byte": "<B", "UInt16": "<H", "Int32": "<i", "UInt32": "<I", "Double": "<d"}


class Reader:
    def __init__(self, octets):
        self.octets, self.at = octets, 0

    def take(self, count):
        assert 0 <= count <= len(self.octets) - self.at, f"{count} octets at {self.at} of {len(self.octets)}"
        self.at += count
        return self.octets[self.at - count:self.at]

    def number(self, kind):
        return struct.unpack(NUMBERS[kind], self.take(struct.calcsize(NUMBERS[kind])))[0]

    def string(self):
        length = self.number("Int32")
        return None if length == -1 else self.take(length).decode()

    def node_id(self):
        form = self.number("Byte")
        if form == 0:
            return self.number("Byte")
        if form == 1:
            assert self.number("Byte") == 0
            return self.number("UInt16")
        if form == 3:
            return self.number("UInt16"), self.string()
        raise AssertionError(f"a NodeId of form {form}")

    def read(self, kind):
        if kind.endswith("[]"):
            count = self.number("Int32")
            return [self.read(kind[:-2]) for _ in range(max(count, 0))]
        if kind in NUMBERS:
            return self.number(kind)
        if kind == "String":
            return self.string()
        if kind == "Guid":
            return self.take(16)
        if kind == "NodeId":
            return self.node_id()
        if kind == "LocalizedText":
            mask = self.number("Byte")
            return [self.string() for bit in (1, 2) if mask & bit]
        if kind == "Variant":
            built_in = self.number("Byte")
            return {0: lambda: None, 5: lambda: self.number("UInt16"), 22: lambda: self.read("ExtensionObject")}[built_in]()
        if kind == "ExtensionObject":
            name, form = self.node_id(), self.number("Byte")
            if form == 0:
                return None
            body = Reader(self.take(self.number("Int32")))
            value = body.read(ENCODINGS[name])
            assert body.at == len(body.octets), f"{name} has octets left"
            return value
        return {name: self.read(of) for name, of in STRUCTURES[kind]}


def read(octets):
    reader = Reader(octets)
    file = reader.read("ExtensionObject")
    assert reader.at == len(octets), "octets are left"
    return file["Body"]
