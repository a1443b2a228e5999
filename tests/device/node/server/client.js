// A stock OPC UA client (node-opcua) against the servers of three takt nodes. Each check is a function; which one is an argument.
// usage: node client.js MODULES CHECK JSON
"use strict";
const path = require("path");
const assert = require("assert");
const [modules, check, text] = process.argv.slice(2);
const opcua = require(path.join(modules, "node-opcua-client"));
const { OPCUACertificateManager } = require(path.join(modules, "node-opcua-certificate-manager"));
const given = JSON.parse(text);
const { AttributeIds, MessageSecurityMode, SecurityPolicy, UserTokenType } = opcua;

const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const state = (node) => `ns=1;s=cell${node ? "." + node : ""}`;

async function makeClient(security, options = {}) {
  const certificates = new OPCUACertificateManager({ rootFolder: given.pki, automaticallyAcceptUnknownCertificate: true });
  await certificates.initialize();
  return opcua.OPCUAClient.create({
    applicationName: "client", applicationUri: "urn:test:takt:client", clientCertificateManager: certificates,
    securityMode: MessageSecurityMode[security.mode], securityPolicy: SecurityPolicy[security.policy], endpointMustExist: false,
    connectionStrategy: { maxRetry: 0, initialDelay: 50 }, requestedSessionTimeout: 60000, ...options
  });
}

async function withSession(endpoint, security, user, what, options) {
  const client = await makeClient(security, options);
  await client.connect(endpoint);
  try {
    const session = await client.createSession(user ? { type: UserTokenType.UserName, userName: user.name, password: user.password } : { type: UserTokenType.Anonymous });
    try {
      return await what(session, client);
    } finally {
      await session.close();
    }
  } finally {
    await client.disconnect();
  }
}

const secure = { policy: "Basic256Sha256", mode: "SignAndEncrypt" };

async function fails(promise, pattern) {
  try {
    await promise;
  } catch (error) {
    assert.match(error.message, pattern);
    return;
  }
  assert.fail(`nothing was wrong where ${pattern} should be`);
}

async function call(session, method, onType) {
  const ids = { Start: 2426, Suspend: 2427, Resume: 2428, Halt: 2429, Reset: 2430 };
  const done = await session.call({ objectId: state(), methodId: onType ? `i=${ids[method]}` : state(method), inputArguments: [] });
  return done.statusCode.name;
}

async function value(session, node, attributeId = AttributeIds.Value) {
  return (await session.read({ nodeId: state(node), attributeId })).value.value;
}

async function until(what, is) {
  const end = Date.now() + 60000;
  for (;;) {
    if (await is()) return;
    assert(Date.now() < end, `${what} does not come`);
    await sleep(20);
  }
}

/// Sees each value of CurrentState, and each event.
async function watch(session) {
  const seen = { states: [], executable: [], events: [] };
  const subscription = await session.createSubscription2({ requestedPublishingInterval: 20, requestedLifetimeCount: 1000, requestedMaxKeepAliveCount: 20, publishingEnabled: true });
  const items = [[state("CurrentState"), AttributeIds.Value, seen.states, (v) => v.value.value.text], [state("Halt"), AttributeIds.Executable, seen.executable, (v) => v.value.value]];
  for (const [nodeId, attributeId, into, of] of items) {
    const item = await subscription.monitor({ nodeId, attributeId }, { samplingInterval: 0, queueSize: 50, discardOldest: true }, opcua.TimestampsToReturn.Both);
    item.on("changed", (v) => into.push(of(v)));
  }
  const filter = opcua.constructEventFilter(["EventId", "EventType", "SourceNode", "SourceName", "Message", "Severity", "Transition", "Transition.Id", "Transition.Number",
    "FromState", "ToState.Number", "Time"], opcua.ofType("i=2378"));
  const events = await subscription.monitor({ nodeId: "i=2253", attributeId: AttributeIds.EventNotifier }, { samplingInterval: 0, queueSize: 100, filter }, opcua.TimestampsToReturn.Both);
  events.on("changed", (fields) => seen.events.push(fields.map((field) => field.value)));
  await until("the first value", () => seen.states.length > 0);
  return seen;
}

const checks = {
  // Each policy and mode: connects, reads, and the endpoints are those that the file says.
  async policies() {
    for (const security of given.securities) {
      await withSession(given.endpoints.plc, security, security.policy === "None" ? null : given.operator, async (session, client) => {
        assert.strictEqual(await value(session, "CurrentState.Number"), 11);
        const endpoints = await client.getEndpoints();
        assert.strictEqual(endpoints.length, given.securities.length);
        const names = await session.read({ nodeId: "i=2255", attributeId: AttributeIds.Value });
        assert.deepStrictEqual(names.value.value, ["http://opcfoundation.org/UA/", "urn:takt:plc"]);
      });
      console.log(`${security.policy} ${security.mode}`);
    }
  },

  async browse() {
    await withSession(given.endpoints.plc, secure, given.operator, async (session) => {
      const path = await session.translateBrowsePath(opcua.makeBrowsePath("ObjectsFolder", "/1:Programs/1:cell/0:CurrentState/0:Id"));
      assert.strictEqual(path.targets[0].targetId.toString(), "ns=1;s=cell.CurrentState.Id");
      // Everything that can be reached can be browsed, and all attributes of it be read.
      const seen = new Set();
      const waiting = ["i=84"];
      while (waiting.length > 0) {
        const nodeId = waiting.pop();
        if (seen.has(nodeId)) continue;
        seen.add(nodeId);
        let result = await session.browse({ nodeId, browseDirection: 2, includeSubtypes: true, resultMask: 63, nodeClassMask: 0, referenceTypeId: null });
        assert.strictEqual(result.statusCode.name, "Good", nodeId);
        for (const reference of result.references) waiting.push(reference.nodeId.toString());
        const values = await session.read([...Array(27).keys()].map((i) => ({ nodeId, attributeId: i + 1 })));
        for (const each of values.slice(0, 4)) assert.strictEqual(each.statusCode.name, "Good", nodeId);
        for (const each of values) assert.match(each.statusCode.name, /Good|BadAttributeIdInvalid/, nodeId);
      }
      assert(seen.size > 450, `${seen.size} nodes`);
      // Continuation points: one reference at a time is the same as all at once.
      const whole = await session.browse({ nodeId: state(), browseDirection: 0, includeSubtypes: true, resultMask: 63, nodeClassMask: 0, referenceTypeId: "i=33" });
      session.requestedMaxReferencesPerNode = 1;
      let part = await session.browse({ nodeId: state(), browseDirection: 0, includeSubtypes: true, resultMask: 63, nodeClassMask: 0, referenceTypeId: "i=33" });
      let count = part.references.length;
      while (part.continuationPoint && part.continuationPoint.length > 0) {
        part = await session.browseNext(part.continuationPoint, false);
        count += part.references.length;
      }
      assert.strictEqual(count, whole.references.length);
      assert.strictEqual((await session.write({ nodeId: state("CurrentState"), attributeId: 13, value: { value: { dataType: "String", value: "x" } } })).name, "BadNotWritable");
      assert.strictEqual((await session.read({ nodeId: "ns=1;s=nothing", attributeId: 13 })).statusCode.name, "BadNodeIdUnknown");
      console.log(`${seen.size} nodes`);
    });
  },

  // The whole life of a group, called at one node and seen at all.
  async program() {
    const sessions = {};
    const seen = {};
    const clients = [];
    for (const [name, endpoint] of Object.entries(given.endpoints)) {
      const client = await makeClient(secure);
      await client.connect(endpoint);
      clients.push(client);
      sessions[name] = await client.createSession({ type: UserTokenType.UserName, userName: given.operator.name, password: given.operator.password });
      seen[name] = await watch(sessions[name]);
    }
    const all = (what) => until(what, () => Object.values(seen).every((each) => each.states[each.states.length - 1] === what));
    const { plc, left, right } = sessions;
    await all("Halted");
    assert.strictEqual(await value(plc, "Start", AttributeIds.Executable), true);
    assert.strictEqual(await value(left, "Start", AttributeIds.Executable), false);
    assert.strictEqual(await call(plc, "Reset"), "BadInvalidState");
    assert.strictEqual(await call(left, "Start"), "BadInvalidState");
    assert.strictEqual(await call(plc, "Start"), "Good");
    await all("Running");
    // A slave may suspend when it knows that the master runs; its server says so by the attribute.
    await until("Suspend is executable", () => value(left, "Suspend", AttributeIds.Executable));
    assert.strictEqual(await call(plc, "Start"), "BadInvalidState");
    assert.strictEqual(await call(left, "Suspend", true), "Good");
    await all("Suspended");
    assert.strictEqual(await call(plc, "Resume"), "Good");
    await all("Running");
    await until("Suspend is executable", () => value(right, "Suspend", AttributeIds.Executable));
    assert.strictEqual(await call(right, "Suspend"), "Good");
    await all("Suspended");
    assert.strictEqual(await call(plc, "Reset", true), "Good");
    await all("Ready");
    assert.strictEqual(await call(left, "Halt"), "Good");
    await all("Halted");
    for (const [name, each] of Object.entries(seen)) {
      assert.deepStrictEqual(each.states, ["Halted", "Ready", "Running", "Suspended", "Running", "Suspended", "Ready", "Halted"], name);
      await until("the last event", () => each.events.length >= 7);
      assert.deepStrictEqual(each.events.map((event) => event[8]), [1, 2, 5, 6, 5, 8, 9], name);
      assert.deepStrictEqual(each.events.map((event) => event[3]), Array(7).fill("cell"), name);
      assert.strictEqual(new Set(each.events.map((event) => event[0].toString("hex"))).size, 7, name);
      assert.strictEqual(each.executable[0], false);
      assert.strictEqual(each.executable[each.executable.length - 1], false);
    }
    const diagnostic = (await plc.read({ nodeId: state("ProgramDiagnostic.LastMethodCall"), attributeId: 13 })).value.value;
    assert.strictEqual(diagnostic, "Reset");
    assert.strictEqual(await value(plc, "Group.Heard.left"), "Halted");
    assert((await value(plc, "Group.LastReaction")) > 0);
    for (const client of clients) await client.disconnect();
    console.log("halted, ready, running, suspended, and back");
  },

  async rights() {
    await withSession(given.endpoints.plc, secure, given.observer, async (session) => {
      assert.strictEqual(await call(session, "Start"), "BadUserAccessDenied");
      assert.strictEqual(await value(session, "Start", AttributeIds.UserExecutable), false);
      assert.strictEqual(await value(session, "Start", AttributeIds.Executable), true);
    });
    await withSession(given.endpoints.plc, { policy: "None", mode: "None" }, given.operator, async (session) => assert.strictEqual(await call(session, "Start"), "BadUserAccessDenied"));
    await withSession(given.endpoints.plc, { policy: "Basic256Sha256", mode: "Sign" }, given.operator, async (session) => {
      assert.strictEqual(await call(session, "Start"), "BadUserAccessDenied");
      assert.strictEqual(await call(session, "Halt"), "BadInvalidState");  // allowed without encryption, and there is nothing to halt
    });
    await fails(withSession(given.endpoints.plc, secure, { name: given.operator.name, password: "wrong" }, async () => {}), /BadUserAccessDenied|BadIdentityToken/);
    console.log("observer, operator without encryption, wrong password");
  },

  async untrusted() {
    await fails(withSession(given.endpoints.plc, secure, given.operator, async () => {}), /./);
    console.log("refused");
  },

  // Tokens of two seconds, and nothing is lost over several renewals.
  async renewals() {
    await withSession(given.endpoints.plc, secure, given.operator, async (session, client) => {
      let renewed = 0;
      client.on("security_token_renewed", () => renewed++);
      const end = Date.now() + 9000;
      while (Date.now() < end) {
        assert.strictEqual(await value(session, "CurrentState.Number"), 11);
        await sleep(5);
      }
      assert(renewed >= 3, `${renewed} renewals`);
      console.log(`${renewed} renewals`);
    }, { defaultSecureTokenLifetime: 2000 });
  },

  async sessions() {
    const all = [];
    for (let i = 0; i < given.count; i++) {
      const client = await makeClient(secure);
      await client.connect(given.endpoints.plc);
      const session = await client.createSession({ type: UserTokenType.UserName, userName: given.operator.name, password: given.operator.password });
      all.push({ client, session, seen: await watch(session) });
    }
    if (given.hold) {
      console.log("subscribed");
      await sleep(given.hold);
    }
    assert.strictEqual(await call(all[0].session, "Start"), "Good");
    await until("Running at all", () => all.every((each) => each.seen.states.at(-1) === "Running"));
    assert.strictEqual(await call(all.at(-1).session, "Halt"), "Good");
    await until("Halted at all", () => all.every((each) => each.seen.states.at(-1) === "Halted" && each.seen.states.length === 4));
    for (const each of all) await each.client.disconnect();
    console.log(`${all.length} sessions`);
  },

  // All at once, and all at once again: whoever has to wait for the server's key waits, and is let in.
  async returning() {
    const come = async () => {
      const client = await makeClient(secure);
      await client.connect(given.endpoints.plc);
      const session = await client.createSession({ type: UserTokenType.UserName, userName: given.operator.name, password: given.operator.password });
      assert.strictEqual(await value(session, "CurrentState.Number"), 11);
      return client;
    };
    for (let round = 0; round < 2; round++) {
      const begin = Date.now();
      const clients = await Promise.all(Array.from({ length: given.count }, come));
      console.log(`${clients.length} at once within ${Date.now() - begin} ms`);
      await Promise.all(clients.map((client) => client.disconnect()));
    }
  },

  // From a call by a client on this machine to the first frame that follows from it: client, TCP, decryption, hand-over, handshake, UDP.
  async frames() {
    const socket = require("dgram").createSocket("udp4");
    await new Promise((resolve) => socket.bind(given.listens, "127.0.0.1", resolve));
    await withSession(given.endpoints.plc, secure, given.operator, async (session) => {
      const times = [];
      for (let i = 0; i < given.count; i++) {
        const come = new Promise((resolve) => {
          const listener = (message) => {
            if (message.length < 24 || message.readUInt32LE(20) !== 15) return;  // Halted.INIT
            socket.off("message", listener);
            resolve(process.hrtime.bigint());
          };
          socket.on("message", listener);
        });
        const begin = process.hrtime.bigint();
        const called = call(session, "Start");
        times.push(Number((await come) - begin) / 1e3);
        assert.strictEqual(await called, "Good");
        assert.strictEqual(await call(session, "Halt"), "Good");
        await until("Halted", async () => (await value(session, "CurrentState.EffectiveDisplayName")).text === "Halted");
      }
      socket.close();
      times.sort((a, b) => a - b);
      console.log(`call to frame: least ${times[0].toFixed(0)} us, median ${times[times.length >> 1].toFixed(0)} us, greatest ${times.at(-1).toFixed(0)} us`);
    });
  },

  // How long a call takes from the request to its answer, at a client of this machine.
  async latency() {
    await withSession(given.endpoints.plc, secure, given.operator, async (session) => {
      const times = [];
      for (let i = 0; i < 200; i++) {
        const begin = process.hrtime.bigint();
        await call(session, "Resume");
        times.push(Number(process.hrtime.bigint() - begin) / 1e3);
      }
      times.sort((a, b) => a - b);
      console.log(`call to answer: median ${times[100].toFixed(0)} us, 99 % ${times[197].toFixed(0)} us`);
    });
  }
};

checks[check]().then(() => process.exit(0), (error) => {
  console.error(error);
  process.exit(1);
});
