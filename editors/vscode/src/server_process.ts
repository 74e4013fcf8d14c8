/** Starts the process of the language server, and knows why it ended. */

import { spawn, type ChildProcess } from "node:child_process";
import { once } from "node:events";
import { setTimeout } from "node:timers/promises";
import { type Command, INSTALL } from "./command";

export class ServerProcess {
  private child: ChildProcess | undefined;
  private errors = "";

  constructor(
    private readonly command: Command,
    private readonly folder: string | undefined,
  ) {}

  /** Start the process; throw if there is no such program. */
  async start(): Promise<ChildProcess> {
    const [program, ...args] = this.command;
    this.errors = "";
    this.child = spawn(program, [...args, "lsp"], { ...(this.folder && { cwd: this.folder }) });
    this.child.stderr?.on("data", (data: Buffer) => (this.errors = (this.errors + data.toString()).slice(-4_000)));
    await once(this.child, "spawn");
    return this.child;
  }

  /** Return why the process has ended, with the last line that it wrote; undefined if it runs. */
  async failure(): Promise<string | undefined> {
    const child = this.child;
    if (!child || child.pid === undefined) {
      return undefined;
    }
    if (child.exitCode === null && child.signalCode === null) {
      await Promise.race([once(child, "close"), setTimeout(1_000)]); // its streams are closed a moment earlier
    }
    const status = child.signalCode ?? (child.exitCode === null ? undefined : `exit code ${child.exitCode}`);
    const last = this.errors.trim().split("\n").at(-1);
    return status && `'${[...this.command, "lsp"].join(" ")}' ended with ${status}: ${last || INSTALL}`;
  }
}
