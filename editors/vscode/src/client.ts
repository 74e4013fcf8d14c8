/** Starts the language server of the compiler, restarts it, and reports why it does not start. */

import * as vscode from "vscode";
import { CloseAction, LanguageClient, type LanguageClientOptions } from "vscode-languageclient/node";
import { expandPath, findCommand, INSTALL } from "./command";
import { ServerProcess } from "./server_process";

/** The files that specs read. */
const READ = "**/*.{yaml,yml,urdf,srdf,xacro,xml,stl,STL,dae,DAE,obj,OBJ}";

export class Compiler {
  private client: LanguageClient | undefined;
  private changes: Promise<void> = Promise.resolve();
  private readonly files = vscode.workspace.createFileSystemWatcher(READ);

  constructor(private readonly output: vscode.LogOutputChannel) {}

  /** Start the server; if there is one, end it first. */
  restart(): Promise<void> {
    return this.change(async () => {
      await this.stop();
      await this.start();
    });
  }

  end(): Promise<void> {
    this.files.dispose();
    return this.change(() => this.stop());
  }

  /** Do one thing after the other. */
  private change(next: () => Promise<void>): Promise<void> {
    this.changes = this.changes.then(next).catch((error: unknown) => this.output.error(String(error)));
    return this.changes;
  }

  private async start(): Promise<void> {
    const command = await findCommand();
    if (!command) {
      void this.report(`LinkForge's compiler is not installed: ${INSTALL}`);
      return;
    }
    this.output.info(`starting ${command.join(" ")} lsp`);
    const server = new ServerProcess(command, vscode.workspace.workspaceFolders?.[0]?.uri.fsPath);
    const options: LanguageClientOptions = {
      documentSelector: [{ scheme: "file", language: "linkforge" }],
      synchronize: { fileEvents: this.files, configurationSection: "linkforge" },
      diagnosticCollectionName: "linkforge", // the owner of the problem matcher: no problem is listed twice
      outputChannel: this.output,
      initializationOptions: serverSettings(),
      initializationFailedHandler: () => false,
      errorHandler: {
        error: (...parameters) => usual.error(...parameters),
        // One that ends before it has started would end again.
        closed: () => (client.hasStarted ? usual.closed() : { action: CloseAction.DoNotRestart, handled: true }),
      },
    };
    const client = new SpecClient("linkforge", "LinkForge", () => server.start(), options);
    const usual = client.createDefaultErrorHandler();
    try {
      await client.start();
      client.hasStarted = true;
      this.client = client;
    } catch (error) {
      void this.report(await server.failure(error));
    }
  }

  private async stop(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    await client?.dispose();
  }

  private async report(problem: string): Promise<void> {
    this.output.error(problem);
    const [copy, settings, retry] = ["Copy pip Command", "Open Settings", "Try Again"];
    const choice = await vscode.window.showErrorMessage(problem, copy, settings, retry);
    if (choice === copy) {
      await vscode.env.clipboard.writeText(INSTALL);
    } else if (choice === settings) {
      await vscode.commands.executeCommand("workbench.action.openSettings", "linkforge.command");
    } else if (choice === retry) {
      await this.restart();
    }
  }
}

/** Shows no error before the server has started, because `Compiler` reports why it does not. */
class SpecClient extends LanguageClient {
  hasStarted = false;

  override error(message: string, data?: unknown, showNotification: boolean | "force" = true): void {
    super.error(message, data, this.hasStarted && showNotification);
  }
}

/** Return the settings that the server reads. */
function serverSettings(): object {
  const settings = vscode.workspace.getConfiguration("linkforge");
  const packages = Object.entries(settings.get<Record<string, string>>("packages", {}));
  return {
    packages: Object.fromEntries(packages.map(([name, path]) => [name, expandPath(path)])),
    inlayHints: settings.get<object>("inlayHints", {}),
  };
}
