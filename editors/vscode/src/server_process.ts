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

  /** Return why it cannot be used: how the process ended, with the last line that it wrote, else the error of a call. */
  async failure(error: unknown): Promise<string> {
    const child = this.child;
    if (child?.pid !== undefined && child.exitCode === null && child.signalCode === null) {
      await Promise.race([once(child, "close"), setTimeout(1_000)]); // its streams are closed a moment earlier
    }
    const shown = `'${[...this.command, "lsp"].join(" ")}'`;
    const status = child?.signalCode ?? (typeof child?.exitCode === "number" && `exit code ${child.exitCode}`);
    if (child?.pid !== undefined && status) {
      return `${shown} ended with ${status}: ${this.errors.trim().split("\n").at(-1) || INSTALL}`;
    }
    return `${shown} cannot be started: ${error instanceof Error ? error.message : String(error)}`;
  }
}
