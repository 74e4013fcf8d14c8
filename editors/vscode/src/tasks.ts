/** Offers tasks that run the compiler, with its problem matcher. */

import * as vscode from "vscode";
import { type Command, findCommand } from "./command";

/** What a task in tasks.json says: `args` are those of `linkforge`. */
interface Definition extends vscode.TaskDefinition {
  args: string[];
}

export class Tasks implements vscode.TaskProvider {
  async provideTasks(): Promise<vscode.Task[]> {
    const command = await findCommand();
    const folders = command ? (vscode.workspace.workspaceFolders ?? []) : [];
    return folders.map((folder) => makeTask(command!, { type: "linkforge", args: ["check"] }, folder));
  }

  async resolveTask(task: vscode.Task): Promise<vscode.Task | undefined> {
    const command = await findCommand();
    return command && makeTask(command, task.definition as Definition, task.scope ?? vscode.TaskScope.Workspace);
  }
}

type Scope = vscode.WorkspaceFolder | vscode.TaskScope.Global | vscode.TaskScope.Workspace;

function makeTask([program, ...first]: Command, definition: Definition, scope: Scope): vscode.Task {
  const execution = new vscode.ProcessExecution(program, [...first, ...definition.args]);
  const task = new vscode.Task(definition, scope, definition.args.join(" "), "linkforge", execution, "$linkforge");
  task.group = vscode.TaskGroup.Build;
  return task;
}
