/** The extension: the language server of `linkforge`, its commands and its tasks. */

import * as vscode from "vscode";
import { Compiler } from "./client";
import { onInterpreterChange } from "./command";
import { Tasks } from "./tasks";

let compiler: Compiler | undefined;

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const output = vscode.window.createOutputChannel("LinkForge", { log: true });
  context.subscriptions.push(
    output,
    vscode.commands.registerCommand("linkforge.showOutput", () => output.show()),
    vscode.commands.registerCommand("linkforge.restart", () => compiler?.restart()),
  );
  if (vscode.workspace.isTrusted) {
    await start(context, output);
  } else {
    context.subscriptions.push(vscode.workspace.onDidGrantWorkspaceTrust(() => start(context, output)));
  }
}

export async function deactivate(): Promise<void> {
  await compiler?.end();
}

async function start(context: vscode.ExtensionContext, output: vscode.LogOutputChannel): Promise<void> {
  const started = new Compiler(output);
  compiler = started;
  const restart = () => void started.restart();
  context.subscriptions.push(
    vscode.tasks.registerTaskProvider("linkforge", new Tasks()),
    vscode.workspace.onDidChangeConfiguration((change) => {
      if (["command", "packages"].some((name) => change.affectsConfiguration(`linkforge.${name}`))) {
        restart();
      }
    }),
  );
  await started.restart();
  const subscription = await onInterpreterChange(restart);
  if (subscription) {
    context.subscriptions.push(subscription);
  }
}
