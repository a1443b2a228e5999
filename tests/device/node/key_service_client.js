// A stock OPC UA client (node-opcua) that asks a key service of takt for keys.
// usage: node key_service_client.js MODULES JSON
"use strict";
const path = require("path");
const fs = require("fs");
const assert = require("assert");
const [modules, text] = process.argv.slice(2);
const opcua = require(path.join(modules, "node-opcua-client"));
const { OPCUACertificateManager } = require(path.join(modules, "node-opcua-certificate-manager"));
const given = JSON.parse(text);
const { DataType, MessageSecurityMode, SecurityPolicy, UserTokenType } = opcua;

const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

async function withSession(user, mode, what) {
  const certificates = new OPCUACertificateManager({ rootFolder: given.pki, automaticallyAcceptUnknownCertificate: true });
  await certificates.initialize();
  const client = opcua.OPCUAClient.create({
    applicationName: "client", applicationUri: "urn:test:takt:client", clientCertificateManager: certificates, securityMode: MessageSecurityMode[mode], securityPolicy: SecurityPolicy.Basic256Sha256,
    endpointMustExist: false, connectionStrategy: { maxRetry: 0, initialDelay: 50 }
  });
  await client.createDefaultCertificate();
  fs.copyFileSync(client.certificateFile, path.join(given.trusted, "client.pem"));
  await sleep(2500);  // the service looks at its folder each second
  await client.connect(given.endpoint);
  try {
    const session = await client.createSession({ type: UserTokenType.UserName, userName: user.name, password: user.password });
    try {
      return await what(session);
    } finally {
      await session.close();
    }
  } finally {
    await client.disconnect();
  }
}

function ask(session, group, token, count) {
  return session.call({
    objectId: "i=14443", methodId: "i=15215",
    inputArguments: [{ dataType: DataType.String, value: group }, { dataType: DataType.UInt32, value: token }, { dataType: DataType.UInt32, value: count }]
  });
}

async function main() {
  const keys = await withSession(given.user, "SignAndEncrypt", async (session) => {
    assert.equal((await ask(session, "none", 0, 1)).statusCode.name, "BadNotFound");
    const path = await session.translateBrowsePath(opcua.makeBrowsePath("i=2253", "/PublishSubscribe.GetSecurityKeys"));
    assert.equal(path.targets[0].targetId.toString(), "ns=0;i=15215");
    const definition = await session.getArgumentDefinition("i=15215");
    assert.deepEqual(definition.outputArguments.map((each) => each.name), ["SecurityPolicyUri", "FirstTokenId", "Keys", "TimeToNextKey", "KeyLifetime"]);
    const current = (await ask(session, "cell", 0, 0)).outputArguments;
    assert.equal(current[2].value.length, 1);
    const before = (await ask(session, "cell", current[1].value - 1, 1)).outputArguments;
    assert.equal(before[1].value, current[1].value - 1);
    assert.deepEqual(before[2].value[1], current[2].value[0]);
    assert.equal((await ask(session, "cell", 0, 1000)).outputArguments[2].value.length, 9);  // no more than it gives
    const answer = await ask(session, "cell", 0, 2);
    assert.equal(answer.statusCode.name, "Good");
    return answer.outputArguments.map((each) => each.value);
  });
  await withSession(given.operator, "SignAndEncrypt", async (session) => assert.equal((await ask(session, "cell", 0, 1)).statusCode.name, "BadUserAccessDenied"));
  console.log(JSON.stringify({ policy: keys[0], first: keys[1], keys: Array.from(keys[2], (each) => Buffer.from(each).toString("hex")), next: keys[3], lifetime: keys[4] }));
}

main().then(() => process.exit(0), (error) => {
  console.error(error);
  process.exit(1);
});
