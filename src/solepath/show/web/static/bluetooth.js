// Web Bluetooth: connects sensors, does what the worker orders (protocol/host.md), and passes on what they send.

import { computer } from "./computer.js";
import { bytes, clock, hex, notified, running, send, startWalk } from "./live.js";
import { sentence } from "./words.js";

const ANSWER_TIME = 20_000; // ms that a sensor has for an answer, and a person to allow a pairing meanwhile
const FIRST_PAUSE = 250; // ms from a lost connection to the next attempt; each further one is twice as long
const MAX_PAUSE = 8000; // ms

// Message "filters" of protocol/host.md: a person may choose a sensor before Python is ready.
const offered = fetch("site.json").then(async (answer) => (await answer.json()).filters);
offered.catch(() => {}); // who chooses hears of it

export const sensors = new Map(); // by the id that the browser has for a sensor

computer.on("orders", (orders) => {
  for (const order of orders) if (order.device) sensors.get(order.device)?.take(order);
});
computer.on("walk", (walk) => {
  for (const sensor of sensors.values()) {
    if (walk === null) sensor.end();
    else if (walk.resumed) sensor.reconnect(); // another worker goes on, which knows of no sensor
  }
});

// What this browser cannot do, in words; "" if it has Web Bluetooth.
export function bluetoothWords() {
  if (navigator.bluetooth) return "";
  const rest = "Recordings and the demonstration can be played here.";
  const { userAgent, maxTouchPoints } = navigator;
  if (!isSecureContext) return `Sensors can be reached only from a page at an https address. ${rest}`;
  if (/iPhone|iPad|iPod/.test(userAgent) || (/Macintosh/.test(userAgent) && maxTouchPoints > 1))
    return `No browser on an iPhone or iPad lets a page reach Bluetooth sensors; Chrome on an Android phone or a computer does. ${rest}`;
  if (/Chrom(e|ium)\//.test(userAgent) && /Linux/.test(userAgent) && !/Android/.test(userAgent))
    return `Chrome on Linux lets a page reach Bluetooth sensors once chrome://flags/#enable-web-bluetooth is enabled. ${rest}`;
  const name = /Firefox\//.test(userAgent) ? "Firefox" : /Safari\//.test(userAgent) && !/Chrom/.test(userAgent) ? "Safari" : "This browser";
  return `${name} has no Web Bluetooth, so that it reaches no sensors; Chrome and Edge do. ${rest}`;
}

// Lets the person choose a sensor, and connects it; site is null for an insole, which knows its foot, and profile for a
// sensor that shows its kind.
export async function addSensor(site, profile) {
  const { filters, services } = await offered;
  computer.emit("happened", { what: "choose" });
  const device = await navigator.bluetooth
    .requestDevice({ filters: filters.map(filterOf), optionalServices: services })
    .catch((error) => refuse(chooserWords(error)));
  if (!device) return;
  await startWalk();
  await sensors.get(device.id)?.end();
  sensors.set(device.id, new Sensor(device, site, profile));
  computer.emit("sensors", sensors);
}

// The page says why in its place for that while nothing is measured, and below its buttons during a walk.
function refuse(refusal) {
  computer.emit("happened", { what: "refuse", refusal });
  if (running() && sensors.size > 0) computer.emit("words", refusal);
}

export const wornWords = (site) => `on the ${site.replace("_", " ")}`;

function filterOf({ name, prefix, service }) {
  if (service) return { services: [service] };
  return prefix ? { namePrefix: prefix } : { name };
}

function chooserWords({ name, message = "" }) {
  if (name === "NotFoundError" && /adapter/i.test(message)) return "Bluetooth is off, or this device has none: turn it on.";
  if (name === "NotFoundError") return "No sensor was chosen. Is it switched on and near?";
  if (name === "SecurityError" || name === "NotAllowedError")
    return "This browser does not let the page use Bluetooth: allow it in the settings of the browser and of the system.";
  return `No sensor can be chosen: ${message}`;
}

// A sensor that is connected again and again until it is ended, or the walk is.
class Sensor {
  characteristics = new Map(); // by "service characteristic"; tests read what they cannot notify
  #ended = false;
  #connected = false; // the worker knows of a connection
  #connection = 0; // number of the connection
  #requests = Promise.resolve();
  #stopPause = () => {};
  #run;

  constructor(device, site, profile) {
    Object.assign(this, { device, site, profile });
    this.#run = this.#stayConnected();
  }

  get name() {
    return this.device.name || "sensor without a name";
  }

  get connected() {
    return this.#connected;
  }

  // What the page says of it.
  get words() {
    const worn = this.site === null ? "" : ` ${wornWords(this.site)}`;
    return `${this.name}${worn}: ${this.#connected ? "connected" : "connecting"}`;
  }

  reconnect() {
    this.#add();
    this.device.gatt.disconnect();
    this.#stopPause();
  }

  // Returns when the connection has ended and the worker knows of it.
  end() {
    this.#ended = true;
    this.device.gatt.disconnect();
    this.#stopPause();
    return this.#run;
  }

  take(order) {
    const { type, reason } = order;
    if (type === "error" && order.of === "add") {
      const isNowhere = this.site === null && !["insole", null].includes(this.profile); // a kind that names no foot
      const help = isNowhere ? "Choose how it is worn before you connect it." : "Disconnect another one first.";
      this.end();
      refuse(`${sentence(`${this.name} cannot be added: ${reason}`)} ${help}`);
    }
    if (order.connection !== this.#connection) return; // it was meant for a connection that has ended
    if (type === "disconnect") {
      this.#ended ||= order.wrong;
      if (order.wrong) refuse(`${sentence(reason)} Choose how it is worn before you connect it.`);
      this.device.gatt.disconnect();
    } else if (["read", "subscribe", "write"].includes(type)) {
      this.#requests = this.#requests.then(() => this.#do(order));
    }
  }

  async #stayConnected() {
    this.#add();
    for (let pause = FIRST_PAUSE; !this.#ended; pause = Math.min(2 * pause, MAX_PAUSE)) {
      const began = performance.now();
      try {
        await this.#use();
      } catch (error) {
        if (running() && !this.#ended) this.#send({ type: "failed", reason: `cannot connect: ${error.message}` });
      }
      if (performance.now() - began > MAX_PAUSE) pause = FIRST_PAUSE;
      if (!this.#ended) await new Promise((resolve) => ((this.#stopPause = resolve), setTimeout(resolve, pause)));
    }
    if (running()) this.#send({ type: "remove" });
    sensors.delete(this.device.id);
    computer.emit("sensors", sensors);
  }

  // Adding twice does nothing.
  #add() {
    if (running()) send({ type: "add", device: this.device.id, site: this.site, profile: this.profile, address: "" });
  }

  async #use() {
    const server = await this.device.gatt.connect();
    const lost = new Promise((resolve) => this.device.addEventListener("gattserverdisconnected", resolve, { once: true }));
    try {
      const characteristics = [];
      this.characteristics.clear();
      for (const service of await server.getPrimaryServices())
        for (const one of await service.getCharacteristics()) {
          const key = `${service.uuid} ${one.uuid}`;
          if (this.characteristics.has(key)) continue;
          this.characteristics.set(key, one);
          characteristics.push([service.uuid, one.uuid, one.properties.notify || one.properties.indicate]);
        }
      if (!running() || this.#ended) return;
      this.#connection += 1;
      this.#send({ type: "connected", connection: this.#connection, name: this.device.name ?? "", characteristics });
      this.#setConnected(true);
      if (server.connected) await lost;
    } finally {
      this.device.gatt.disconnect();
      if (this.#connected && running()) this.#send({ type: "disconnected" });
      this.#setConnected(false);
    }
  }

  #setConnected(connected) {
    this.#connected = connected;
    computer.emit("sensors", sensors);
  }

  async #do(order) {
    const isOver = () => order.connection !== this.#connection || !this.#connected || !running();
    if (isOver()) return;
    try {
      const value = await inTime(this.#perform(order));
      if (!isOver()) this.#send({ type: "done", connection: order.connection, value: value ? hex(value) : "" });
    } catch (error) {
      if (isOver() || !this.device.gatt.connected) return; // the loss of the connection says it all
      if (error.name !== "TimeoutError")
        return this.#send({ type: "rejected", connection: order.connection, reason: error.message || error.name });
      this.#send({ type: "failed", reason: "the sensor did not answer in time: it is connected again" });
      this.device.gatt.disconnect();
    }
  }

  // Returns the value that was read; of a write and a subscription nothing.
  async #perform({ type, service, characteristic, channel, value }) {
    const one = this.characteristics.get(`${service} ${characteristic}`);
    if (type === "read") return one.readValue();
    if (type === "write") {
      const { write } = one.properties;
      return write ? one.writeValueWithResponse(bytes(value)) : one.writeValueWithoutResponse(bytes(value));
    }
    one.oncharacteristicvaluechanged = () => running() && notified(this.device.id, channel, one.value);
    await one.startNotifications();
  }

  #send(message) {
    send({ ...message, device: this.device.id, t: clock() });
  }
}

function inTime(promise) {
  const late = new DOMException("no answer", "TimeoutError");
  return Promise.race([promise, new Promise((_, reject) => setTimeout(() => reject(late), ANSWER_TIME))]);
}
