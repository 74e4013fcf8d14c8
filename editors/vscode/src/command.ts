/** Finds the command that starts the compiler. */

import { execFile } from "node:child_process";
import { homedir } from "node:os";
import * as vscode from "vscode";

/** A program and its first arguments. */
export type Command = readonly [program: string, ...args: string[]];

/** What this extension uses of the API of the extension ms-python.python. */
interface PythonExtension {
  environments: {
    getActiveEnvironmentPath(): { path: string };
    resolveEnvironment(environment: { path: string }): Promise<{ executable: { uri?: vscode.Uri } } | undefined>;
    onDidChangeActiveEnvironmentPath: vscode.Event<unknown>;
  };
}

export const INSTALL = "pip install 'linkforge-compile[lsp]'";

/** Return the command of the settings, else the first one that works; undefined if there is none. */
export async function findCommand(): Promise<Command | undefined> {
  const [program, ...args] = vscode.workspace.getConfiguration("linkforge").get<string[]>("command", []);
  if (program) {
    return [expandPath(program), ...args.map(expandPath)];
  }
  const interpreter = await selectedInterpreter();
  const candidates: Command[] = [["linkforge"]];
  if (interpreter) {
    candidates.unshift([interpreter, "-m", "linkforge_compile"]);
  }
  for (const candidate of candidates) {
    if (await isRunning(candidate)) {
      return candidate;
    }
  }
  return undefined;
}

/** Call a function whenever another interpreter is selected in the Python extension. */
export async function onInterpreterChange(call: () => void): Promise<vscode.Disposable | undefined> {
  return (await pythonExtension())?.environments.onDidChangeActiveEnvironmentPath(call);
}

/** Replace `~` and `${workspaceFolder}` at the start of a setting. */
export function expandPath(text: string): string {
  const folder = vscode.workspace.workspaceFolders?.[0]?.uri.fsPath;
  return text
    .replace(/^~(?=$|[\\/])/, () => homedir())
    .replace(/^\$\{workspaceFolder\}/, (found) => folder ?? found);
}

async function pythonExtension(): Promise<PythonExtension | undefined> {
  return vscode.extensions.getExtension<PythonExtension>("ms-python.python")?.activate();
}

async function selectedInterpreter(): Promise<string | undefined> {
  const environments = (await pythonExtension())?.environments;
  const selected = await environments?.resolveEnvironment(environments.getActiveEnvironmentPath());
  return selected?.executable.uri?.fsPath;
}

function isRunning([program, ...args]: Command): Promise<boolean> {
  return new Promise((resolve) => {
    execFile(program, [...args, "--version"], { timeout: 20_000 }, (error) => resolve(!error));
  });
}
