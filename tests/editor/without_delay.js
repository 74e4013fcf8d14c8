// Loaded before yaml-language-server: it validates at once, not 200 ms after the last key that somebody typed.
const path = require("path");
const server = path.dirname(path.dirname(process.argv[1]));
const { SettingsState } = require(path.join(server, "out/server/src/yamlSettings"));
Object.defineProperty(SettingsState.prototype, "validationDelayMs", { get: () => 0, set: () => {} });
